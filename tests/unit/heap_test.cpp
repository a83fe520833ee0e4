#include "server/heap.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <memory>
#include <new>
#include <thread>
#include <vector>

#include "papilio/buffer.h"

namespace papilio::server {
namespace {

constexpr size_t block_bytes = 64U << 10;
constexpr size_t blocks = 2048;  // 128 MiB

size_t resident_bytes() {
  std::ifstream pages("/proc/self/statm");
  size_t size = 0;
  size_t resident = 0;
  pages >> size >> resident;
  return resident * static_cast<size_t>(sysconf(_SC_PAGESIZE));
}

/// Takes and frees memory as a large request does, and keeps small blocks between that prevent its return.
std::vector<std::unique_ptr<char>> leave_holes() {
  std::vector<std::unique_ptr<char>> kept;
  std::vector<std::vector<char>> freed;
  for (size_t i = 0; i < blocks; ++i) {
    freed.emplace_back(block_bytes, 'x');
    kept.push_back(std::make_unique<char>('x'));
  }
  return kept;
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SKIP_WITHOUT_GLIBC() GTEST_SKIP() << "the sanitizers replace the allocator"
#else
#define SKIP_WITHOUT_GLIBC()
#endif

TEST(FreeMemory, MemoryIsReturnedOnceRequestsAreDone) {
  SKIP_WITHOUT_GLIBC();
  FreeMemory memory;
  const auto kept = leave_holes();
  const size_t before = resident_bytes();
  memory.give_back();
  EXPECT_GT(resident_bytes(), before - blocks * block_bytes / 8) << "no request, so no memory is returned";
  memory.count_request();
  memory.give_back();
  EXPECT_GT(resident_bytes(), before - blocks * block_bytes / 8) << "another request may follow";
  memory.give_back();
  EXPECT_LT(resident_bytes(), before - blocks * block_bytes / 2);
}

TEST(FreeMemory, MemoryIsReturnedBetweenContinuousRequests) {
  SKIP_WITHOUT_GLIBC();
  FreeMemory memory;
  const auto kept = leave_holes();
  const size_t before = resident_bytes();
  for (int second = 0; second < 5; ++second) {
    EXPECT_GT(resident_bytes(), before - blocks * block_bytes / 8) << second;
    memory.count_request();
    memory.give_back();
  }
  EXPECT_LT(resident_bytes(), before - blocks * block_bytes / 2);
}

TEST(FreeMemory, ArenaEndsAreReturnedAfterRequests) {
  SKIP_WITHOUT_GLIBC();
  set_up_heap(2);
  FreeMemory memory;
  const size_t before = resident_bytes();
  const auto work = [&] {
    std::vector<std::vector<char>> held;
    for (size_t i = 0; i < blocks / 4; ++i) held.emplace_back(block_bytes, 'x');
    held.clear();
    memory.count_request();
  };
  std::thread(work).join();
  std::thread(work).join();
  EXPECT_GT(resident_bytes(), before + blocks / 8 * block_bytes) << "memory was returned between requests";
  memory.give_back();
  memory.give_back();
  EXPECT_LT(resident_bytes(), before + (2U << 20));
}

TEST(Heap, SpareBlocksAreReturnedBeforeNewFails) {
  set_up_heap(2);
  const std::new_handler handler = std::get_new_handler();
  ASSERT_NE(handler, nullptr);
  give_block(take_block(1 << 20), 1 << 20);
  if (spare_bytes() > 0) handler();  // the address sanitizer keeps no spare blocks
  EXPECT_EQ(spare_bytes(), 0U);
  EXPECT_THROW(handler(), std::bad_alloc);
  std::set_new_handler(nullptr);
}

}  // namespace
}  // namespace papilio::server
