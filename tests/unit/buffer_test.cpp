#include "papilio/buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace papilio {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool keeps_blocks = false;  // no blocks are reused under this sanitizer
#else
constexpr bool keeps_blocks = true;
#endif

TEST(BufferBlocks, BlocksAreAlignedAndDisjoint) {
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

TEST(BufferBlocks, BlocksAreReusedForSimilarSizes) {
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

TEST(BufferBlocks, ReleaseKeepsAtMostTheGivenBytes) {
  if (!keeps_blocks) return;
  constexpr size_t small = 1 << 12, large = 1 << 20;
  release_spare_blocks();
  std::vector<std::pair<void*, size_t>> blocks;
  for (int i = 0; i < 8; ++i)
    for (const size_t bytes : {small, large}) blocks.emplace_back(take_block(bytes), bytes);
  for (const auto& [block, bytes] : blocks) give_block(block, bytes);
  ASSERT_EQ(spare_bytes(), 8 * (small + large));
  release_spare_blocks(8 * (small + large));
  EXPECT_EQ(spare_bytes(), 8 * (small + large));
  release_spare_blocks(6 * large);  // two of the large ones, and the small ones
  EXPECT_EQ(spare_bytes(), 6 * large);
  release_spare_blocks(6 * large - 1);
  EXPECT_EQ(spare_bytes(), 5 * large);
  release_spare_blocks();
  EXPECT_EQ(spare_bytes(), 0U);
}

TEST(Buffer, AssigningNothingReturnsTheMemory) {
  Buffer<uint32_t> numbers(1000, 7);
  numbers.clear();
  EXPECT_GE(numbers.capacity(), 1000U);
  numbers = {};
  EXPECT_EQ(numbers.capacity(), 0U);
  EXPECT_TRUE(numbers.empty());
  numbers = {1, 2};
  EXPECT_EQ(numbers, (Buffer<uint32_t>{1, 2}));
}

TEST(BufferBlocks, BlocksAreThreadSafe) {
  std::vector<std::thread> threads;
  for (uint32_t t = 0; t < 4; ++t)
    threads.emplace_back([t] {
      for (uint32_t i = 0; i < 2000; ++i) {
        Buffer<uint32_t> numbers(100 + i % 700, t);
        for (uint32_t n : numbers) ASSERT_EQ(n, t);
      }
    });
  for (std::thread& thread : threads) thread.join();
}

// Otherwise later small allocations at these addresses would occupy pages of 2 MiB.
TEST(BufferBlocks, FreedAddressesLoseHugePages) {
  give_block(take_block(size_t{9} << 20), size_t{9} << 20);
  release_spare_blocks();
  std::ifstream maps("/proc/self/smaps");
  for (std::string line; std::getline(maps, line);)
    if (line.starts_with("VmFlags:")) {
      EXPECT_EQ(line.find(" hg"), std::string::npos);
    }
}

TEST(BufferBlocks, TooManyElementsAreRefused) {
  EXPECT_THROW((void)Buffer<uint64_t>::for_overwrite(SIZE_MAX / 4), std::bad_alloc);
}

using Numbers = Buffer<uint32_t>;

TEST(Buffer, ConstructorsTakeCountsValuesListsAndRanges) {
  EXPECT_TRUE(Numbers().empty());
  EXPECT_EQ(Numbers(3), (Numbers{0, 0, 0}));
  EXPECT_EQ(Numbers(2, 7), (Numbers{7, 7}));
  const std::vector<uint32_t> range{1, 2, 3};
  EXPECT_EQ(Numbers(range.begin(), range.end()), (Numbers{1, 2, 3}));
  EXPECT_EQ(Numbers::for_overwrite(5).size(), 5U);
}

TEST(Buffer, NewElementsAreZeroOrTheValueGiven) {
  { Numbers dirt(3000, 0xffffffff); }  // its block is reused below
  Numbers numbers(1000, 7);
  numbers.resize(2000);
  EXPECT_EQ(numbers[999], 7U);
  EXPECT_TRUE(std::all_of(numbers.begin() + 1000, numbers.end(), [](uint32_t n) { return n == 0; }));
  numbers.resize(2500, 8);
  EXPECT_EQ(numbers[1999], 0U);
  EXPECT_EQ(numbers.back(), 8U);
  numbers.resize(500);
  numbers.resize_for_overwrite(600);
  EXPECT_EQ(numbers.size(), 600U);
  EXPECT_EQ(numbers[499], 7U);
}

TEST(Buffer, ResizeForOverwriteKeepsTheOldElements) {
  Numbers numbers{1, 2, 3};
  numbers.resize_for_overwrite(100000);
  EXPECT_EQ(Numbers(numbers.begin(), numbers.begin() + 3), (Numbers{1, 2, 3}));
}

TEST(Buffer, PushBackAcceptsItsOwnElement) {
  Numbers numbers{1};
  for (uint32_t i = 0; i < 1000; ++i) numbers.push_back(numbers.front());
  EXPECT_EQ(numbers, Numbers(1001, 1));
  numbers.pop_back();
  EXPECT_EQ(numbers.size(), 1000U);
}

TEST(Buffer, InsertWorksInTheMiddleAndAtTheEnd) {
  Numbers numbers{1, 5};
  const std::vector<uint32_t> between{2, 3, 4};
  EXPECT_EQ(*numbers.insert(numbers.begin() + 1, between.begin(), between.end()), 2U);
  numbers.insert(numbers.end(), {6, 7});
  EXPECT_EQ(numbers, (Numbers{1, 2, 3, 4, 5, 6, 7}));
}

TEST(Buffer, CopiesAreDeepAndMovesKeepTheMemory) {
  Numbers numbers{1, 2, 3};
  Numbers copy = numbers;
  EXPECT_EQ(copy, numbers);
  EXPECT_NE(copy.data(), numbers.data());
  const uint32_t* data = numbers.data();
  Numbers moved = std::move(numbers);
  EXPECT_EQ(moved.data(), data);
  copy = std::move(moved);
  EXPECT_EQ(copy.data(), data);
  copy = Numbers(copy);
  EXPECT_EQ(copy, (Numbers{1, 2, 3}));
  copy = {4};
  EXPECT_EQ(copy, (Numbers{4}));
  Numbers other;
  swap(copy, other);
  EXPECT_TRUE(copy.empty());
  EXPECT_EQ(other, (Numbers{4}));
}

TEST(Buffer, AssignAndClearKeepReservedMemory) {
  Numbers numbers;
  numbers.reserve(100);
  EXPECT_EQ(numbers.capacity(), 100U);
  const uint32_t* data = numbers.data();
  numbers.assign(100, 3);
  EXPECT_EQ(numbers.data(), data);
  numbers.assign({1, 2, 3, 4});
  EXPECT_EQ(erase_if(numbers, [](uint32_t n) { return n % 2 == 0; }), 2U);
  EXPECT_EQ(numbers, (Numbers{1, 3}));
  numbers.clear();
  EXPECT_TRUE(numbers.empty());
  EXPECT_EQ(numbers.capacity(), 100U);
}

TEST(Buffer, DataIsAlignedAndReadableBehindItsEnd) {
  for (size_t count : {1, 63, 64, 1000}) {
    Buffer<uint8_t> bytes(count);
    EXPECT_EQ(reinterpret_cast<uintptr_t>(bytes.data()) % 64, 0U);
    std::array<uint8_t, Buffer<uint8_t>::readable_behind_end> behind{};
    std::memcpy(behind.data(), bytes.data() + bytes.size(), behind.size());
  }
}

}  // namespace
}  // namespace papilio
