#include "papilio/buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

namespace papilio {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool keeps_blocks = false;  // nothing is kept under this sanitizer
#else
constexpr bool keeps_blocks = true;
#endif

TEST(ArrayBlocks, AreAlignedAndTheirOwn) {
  for (size_t bytes :
       {size_t{0}, size_t{1}, size_t{255}, size_t{256}, size_t{257}, size_t{1} << 21, (size_t{5} << 20) + 3}) {
    void* one = take_block(bytes);
    void* other = take_block(bytes);
    EXPECT_NE(one, other);
    EXPECT_EQ(reinterpret_cast<uintptr_t>(one) % 64, 0U) << bytes;
    std::fill_n(static_cast<uint8_t*>(one), bytes, 1);
    std::fill_n(static_cast<uint8_t*>(other), bytes, 2);
    EXPECT_TRUE(
        std::all_of(static_cast<uint8_t*>(one), static_cast<uint8_t*>(one) + bytes, [](uint8_t b) { return b == 1; }));
    give_block(one, bytes);
    give_block(other, bytes);
  }
}

TEST(ArrayBlocks, ComeBackForASizeALittleLargerAndSmaller) {
  for (size_t bytes = 300; bytes < 40'000'000; bytes = bytes * 3 / 2) {
    void* block = take_block(bytes);
    give_block(block, bytes);
    const size_t kept = spare_bytes();
    EXPECT_GE(kept, keeps_blocks ? bytes : 0);
    EXPECT_LE(kept, keeps_blocks ? spare_limit : 0);
    void* again = take_block(bytes - bytes / 100);
    EXPECT_LE(spare_bytes(), kept);
    give_block(again, bytes - bytes / 100);
  }
  release_spare_blocks();
  EXPECT_EQ(spare_bytes(), 0U);
}

TEST(ArrayBlocks, AreSharedByThreads) {
  std::vector<std::thread> threads;
  for (uint32_t t = 0; t < 4; ++t)
    threads.emplace_back([t] {
      for (uint32_t i = 0; i < 2000; ++i) {
        Array<uint32_t> numbers(100 + i % 700, t);
        for (uint32_t n : numbers) ASSERT_EQ(n, t);
      }
    });
  for (std::thread& thread : threads) thread.join();
}

// Small things that come to lie there would fill pages of 2 MiB, long after.
TEST(ArrayBlocks, LeaveNoAddressesBehindForHugePages) {
  give_block(take_block(size_t{9} << 20), size_t{9} << 20);
  release_spare_blocks();
  std::ifstream maps("/proc/self/smaps");
  for (std::string line; std::getline(maps, line);)
    if (line.starts_with("VmFlags:")) {
      EXPECT_EQ(line.find(" hg"), std::string::npos);
    }
}

TEST(ArrayBlocks, TooManyElementsAreRefused) {
  EXPECT_THROW((void)ArrayAllocator<uint64_t>().allocate(SIZE_MAX / 4), std::bad_alloc);
}

TEST(ArrayTest, IsFilledOnlyWhereAValueIsGiven) {
  Array<uint32_t> numbers(1000, 7);
  numbers.resize(2000, 8);
  EXPECT_EQ(numbers[999], 7U);
  EXPECT_EQ(numbers[1999], 8U);
  numbers.resize(500);
  EXPECT_EQ(numbers[499], 7U);
  const Array<uint32_t> copy = numbers;
  EXPECT_EQ(copy, numbers);
}

}  // namespace
}  // namespace papilio
