#include "server/container_limits.h"

#include <gtest/gtest.h>

#include <fstream>
#include <thread>

namespace papilio::server {
namespace {

namespace fs = std::filesystem;

/// A folder of control groups in the kernel's format.
class ContainerLimitsTest : public testing::Test {
 protected:
  ContainerLimitsTest() {
    std::string name = (fs::temp_directory_path() / "papilio-groups-XXXXXX").string();
    root_ = ::mkdtemp(name.data());
  }
  ~ContainerLimitsTest() override { fs::remove_all(root_); }

  void write(const std::string& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }
  [[nodiscard]] ContainerLimits limits() const { return container_limits(root_ / "groups", root_ / "membership"); }

 private:
  fs::path root_;
};

TEST_F(ContainerLimitsTest, UnreadableGroupsAreNoLimit) {
  EXPECT_FALSE(limits().cores);
  EXPECT_FALSE(limits().memory_bytes);
}

TEST_F(ContainerLimitsTest, LimitsOfVersion2AreRead) {
  write("membership", "0::/\n");
  write("groups/cpu.max", "150000 100000\n");
  write("groups/memory.max", "1073741824\n");
  EXPECT_EQ(limits().cores, 1.5);
  EXPECT_EQ(limits().memory_bytes, 1073741824U);
}

TEST_F(ContainerLimitsTest, Version2MayHaveNoLimits) {
  write("membership", "0::/\n");
  write("groups/cpu.max", "max 100000\n");
  write("groups/memory.max", "max\n");
  EXPECT_FALSE(limits().cores);
  EXPECT_FALSE(limits().memory_bytes);
}

TEST_F(ContainerLimitsTest, LowestLimitOfAllAncestorsHolds) {
  write("membership", "0::/service/worker\n");
  write("groups/service/worker/memory.max", "max\n");
  write("groups/service/worker/cpu.max", "400000 100000\n");
  write("groups/service/memory.max", "5000000\n");
  write("groups/service/cpu.max", "50000 25000\n");
  EXPECT_EQ(limits().cores, 2);
  EXPECT_EQ(limits().memory_bytes, 5000000U);
}

TEST_F(ContainerLimitsTest, LimitsOfVersion1AreRead) {
  write("membership", "5:memory:/\n3:cpu,cpuacct:/\n1:name=systemd:/\nodd\n");
  write("groups/memory/memory.limit_in_bytes", "268435456\n");
  write("groups/cpu,cpuacct/cpu.cfs_quota_us", "300000\n");
  write("groups/cpu,cpuacct/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(limits().cores, 3);
  EXPECT_EQ(limits().memory_bytes, 268435456U);
}

TEST_F(ContainerLimitsTest, Version1MayHaveNoLimits) {
  write("membership", "5:memory:/\n3:cpu:/\n");
  write("groups/memory/memory.limit_in_bytes", "9223372036854771712\n");
  write("groups/cpu/cpu.cfs_quota_us", "-1\n");
  write("groups/cpu/cpu.cfs_period_us", "100000\n");
  EXPECT_FALSE(limits().cores);
  EXPECT_FALSE(limits().memory_bytes);
}

TEST_F(ContainerLimitsTest, HostPathFallsBackToTheContainersRoot) {
  write("membership", "5:memory:/host/path/of/this\n");
  write("groups/memory/memory.limit_in_bytes", "268435456\n");
  EXPECT_EQ(limits().memory_bytes, 268435456U);
}

TEST(UsableCores, CoresAreBoundedByTheLimitAndTheHardware) {
  const int all = static_cast<int>(std::thread::hardware_concurrency());
  EXPECT_EQ(usable_cores({}), all);
  EXPECT_EQ(usable_cores({.cores = 0.2, .memory_bytes = {}}), 1);
  EXPECT_EQ(usable_cores({.cores = 1.0, .memory_bytes = {}}), 1);
  EXPECT_EQ(usable_cores({.cores = 1e6, .memory_bytes = {}}), all);
}

}  // namespace
}  // namespace papilio::server
