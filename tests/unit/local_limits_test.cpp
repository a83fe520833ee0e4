#include "client/lib/local_limits.h"

#include "papilio/mesh.h"
#include "tests/support/mesh_file_fixture.h"

namespace papilio::client {
namespace {

class LocalLimits : public MeshFileTest {
 protected:
  MemoryFiles files_{path("meminfo"), path("memory.max")};
};

TEST_F(LocalLimits, ThreeQuartersOfTheFreeMemoryAreShared) {
  put("meminfo", "MemTotal:  16000 kB\nMemFree:   1000 kB\nMemAvailable:    8000 kB\nBuffers: 7 kB\n");
  put("memory.max", "max\n");
  EXPECT_EQ(local_limits(1, files_).max_compute_bytes, 6000U << 10U);
  EXPECT_EQ(local_limits(3, files_).max_compute_bytes, 2000U << 10U);
  EXPECT_EQ(local_limits(1, files_).max_output_faces, face_count_limit);
}

TEST_F(LocalLimits, MemoryOfTheContainerIsTheLimitIfItIsLess) {
  put("meminfo", "MemAvailable:    8000 kB\n");
  put("memory.max", "4096000\n");
  EXPECT_EQ(local_limits(1, files_).max_compute_bytes, 3072000U);
}

TEST_F(LocalLimits, NothingIsLimitedIfNothingIsKnown) {
  EXPECT_EQ(local_limits(1, files_).max_compute_bytes, 0U);
  put("meminfo", "no numbers\n");
  put("memory.max", "");
  EXPECT_EQ(local_limits(1, files_).max_compute_bytes, 0U);
}

TEST_F(LocalLimits, MemoryOfThisMachineIsKnown) { EXPECT_GT(local_limits(1).max_compute_bytes, 1U << 20U); }

}  // namespace
}  // namespace papilio::client
