#include "server/container_memory.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <new>
#include <vector>

#include "server/address_space.h"

namespace papilio::server {
namespace {

uint64_t data_limit() {
  rlimit limit{};
  ::getrlimit(RLIMIT_DATA, &limit);
  return limit.rlim_cur;
}

// CTest runs each test in a process of its own; within one process the bound would affect later tests.
class ContainerMemory : public testing::Test {
 protected:
  void SetUp() override {
    if (is_sanitized) GTEST_SKIP() << "sanitizers reserve terabytes";
    ::getrlimit(RLIMIT_DATA, &before_);
  }
  void TearDown() override { ::setrlimit(RLIMIT_DATA, &before_); }

 private:
  rlimit before_{};
};

TEST_F(ContainerMemory, WritableMemoryIsBounded) {
  bound_by_container(1600ULL << 20);
  EXPECT_EQ(data_limit(), 1500ULL << 20);
  EXPECT_THROW(std::vector<char>(1600ULL << 20), std::bad_alloc);
  EXPECT_NO_THROW(std::vector<char>(100ULL << 20));
}

TEST_F(ContainerMemory, BoundGrowsByTheStacksOfThreads) {
  bound_by_container(1600ULL << 20);
  const uint64_t alone = data_limit();
  {
    const StackSpace one;
    const StackSpace other;
    EXPECT_EQ(data_limit(), alone + 2 * stack_bytes);
  }
  EXPECT_EQ(data_limit(), alone);
}

TEST(StackSpace, UnboundedMemoryIsUnchanged) {
  const uint64_t before = data_limit();
  const StackSpace one;
  EXPECT_EQ(data_limit(), before);
}

}  // namespace
}  // namespace papilio::server
