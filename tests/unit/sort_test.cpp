#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "base/sort.h"

namespace papilio {
namespace {

using Numbers = std::vector<uint32_t>;

/// Returns `count` numbers below `bound`.
Numbers random_numbers(size_t count, uint32_t bound, uint32_t seed) {
  std::mt19937 random(seed);
  Numbers numbers(count);
  for (uint32_t& number : numbers) number = random() % bound;
  return numbers;
}

/// Returns 0, 1, ... in an order in which every median of three is the second smallest number of its range.
Numbers numbers_that_split_badly(uint32_t half) {
  Numbers numbers(size_t{2} * half);
  for (uint32_t i = 0; i < half; ++i) {
    numbers[i] = i % 2 == 0 ? i : half + i - 1 + half % 2;
    numbers[half + i] = 2 * i + 1;
  }
  return numbers;
}

Numbers sorted_by_library(Numbers numbers) {
  std::ranges::sort(numbers);
  return numbers;
}

Numbers sorted_in_small(Numbers numbers, int splits) {
  small_sort(numbers.data(), numbers.data() + numbers.size(), std::less<>(), splits);
  return numbers;
}

class SmallSort : public testing::TestWithParam<int> {};  // splits before heapsort

TEST_P(SmallSort, RandomNumbersAreSorted) {
  for (const size_t count : {0U, 1U, 2U, 3U, 15U, 16U, 17U, 18U, 100U, 1000U, 20000U})
    for (const uint32_t bound : {1U, 2U, 10U, UINT32_MAX}) {
      const Numbers numbers = random_numbers(count, bound, static_cast<uint32_t>(count) + bound);
      EXPECT_EQ(sorted_in_small(numbers, GetParam()), sorted_by_library(numbers)) << count << " below " << bound;
    }
}

TEST_P(SmallSort, OrderedAndReversedNumbersAreSorted) {
  Numbers numbers = sorted_by_library(random_numbers(5000, 4000, 7));
  EXPECT_EQ(sorted_in_small(numbers, GetParam()), numbers);
  Numbers backwards(numbers.rbegin(), numbers.rend());
  EXPECT_EQ(sorted_in_small(backwards, GetParam()), numbers);
  backwards.insert(backwards.end(), numbers.begin(), numbers.end());
  EXPECT_EQ(sorted_in_small(backwards, GetParam()), sorted_by_library(backwards));
}

INSTANTIATE_TEST_SUITE_P(Splits, SmallSort, testing::Values(0, 3, 64));

TEST(Sort, ArraysAreSortedByACustomOrder) {
  std::vector<std::array<uint32_t, 3>> ours(1000);
  std::mt19937 random(3);
  for (auto& one : ours) one = {static_cast<uint32_t>(random() % 5), static_cast<uint32_t>(random() % 5), 0};
  for (uint32_t i = 0; i < ours.size(); ++i) ours[i][2] = i;
  auto library = ours;
  const auto greater = [](const auto& a, const auto& b) { return a > b; };
  small_sort(ours.data(), ours.data() + ours.size(), greater, 20);
  std::ranges::sort(library, greater);
  EXPECT_EQ(ours, library);
}

TEST(Sort, ComparisonsAreBoundedByNLogN) {
  for (const Numbers& input :
       {numbers_that_split_badly(20000), Numbers(40000, 5), random_numbers(40000, UINT32_MAX, 1)}) {
    Numbers numbers = input;
    size_t compared = 0;
    const double logarithm = std::log2(static_cast<double>(numbers.size()));
    small_sort(
        numbers.data(), numbers.data() + numbers.size(),
        [&](uint32_t a, uint32_t b) {
          ++compared;
          return a < b;
        },
        2 * static_cast<int>(logarithm));
    EXPECT_TRUE(std::ranges::is_sorted(numbers));
    EXPECT_LT(static_cast<double>(compared), 6 * static_cast<double>(numbers.size()) * logarithm);
  }
}

}  // namespace
}  // namespace papilio
