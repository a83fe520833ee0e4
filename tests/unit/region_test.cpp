#include "core/mesh/region.h"

#include <gtest/gtest.h>

#include <random>

namespace papilio {
namespace {

std::vector<uint32_t> one_by_one(const Buffer<uint8_t>& marks) {
  std::vector<uint32_t> numbers;
  for (uint32_t i = 0; i < marks.size(); ++i)
    if (marks[i] != 0) numbers.push_back(i);
  return numbers;
}

TEST(Marked, MarkedNumbersAreFoundAtAnyDensity) {
  std::mt19937 random(3);
  for (const size_t size : {0, 1, 3, 4, 5, 63, 64, 65, 127, 1000, 4099})
    for (const double share : {0.0, 0.001, 0.05, 0.07, 0.5, 0.97, 1.0})
      for (int repeat = 0; repeat < 5; ++repeat) {
        Buffer<uint8_t> marks(size);
        for (uint8_t& mark : marks) mark = std::bernoulli_distribution(share)(random) ? 1 : 0;
        const Buffer<uint32_t> numbers = marked(marks);
        ASSERT_EQ(std::vector<uint32_t>(numbers.begin(), numbers.end()), one_by_one(marks)) << size << ' ' << share;
      }
}

}  // namespace
}  // namespace papilio
