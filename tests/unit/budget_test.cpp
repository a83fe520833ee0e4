#include "core/criteria/budget.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <random>

namespace papilio {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

TEST(ThresholdWithin, LargestErrorsThatFitAreTaken) {
  const Buffer<WeighedEdge> edges{{1, 2}, {4, 2}, {3, 1}, {2, 2}, {3, 2}};
  EXPECT_EQ(threshold_within(edges, 0, 10, 19), 0);  // all fit: nine more faces
  EXPECT_EQ(threshold_within(edges, 2.5F, 10, 15), 2.5F);
  EXPECT_EQ(threshold_within(edges, 0, 10, 18), 2);
  EXPECT_EQ(threshold_within(edges, 0, 10, 15), 3);
  EXPECT_EQ(threshold_within(edges, 0, 10, 14), 4);  // equal errors are split together
  EXPECT_EQ(threshold_within(edges, 0, 10, 12), 4);
  EXPECT_EQ(threshold_within(edges, 0, 10, 11), infinity);
  EXPECT_EQ(threshold_within(edges, 0, 20, 19), infinity);
  EXPECT_EQ(threshold_within({}, 0.5F, 10, 10), 0.5F);
}

/// Returns threshold_within() computed by sorting.
float by_sorting(const Buffer<WeighedEdge>& edges, float least, uint64_t faces, uint64_t budget) {
  std::map<float, uint64_t, std::greater<>> faces_of;
  for (const WeighedEdge& e : edges)
    if (e.error >= least) faces_of[e.error] += e.faces;
  float threshold = infinity;
  for (const auto& [error, more] : faces_of) {
    faces += more;
    if (faces > budget) return threshold;
    threshold = error;
  }
  return faces > budget ? infinity : least;
}

TEST(ThresholdWithin, ThresholdEqualsThatOfSortedErrors) {
  std::mt19937 random(7);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (int round = 0; round < 400; ++round) {
    Buffer<WeighedEdge> edges(random() % 200);
    const float spread = std::uniform_real_distribution<float>(0, 30)(random);
    for (auto& [error, faces] : edges) {
      error = std::exp(std::uniform_real_distribution<float>(-spread, spread)(random));
      if (random() % 4 == 0) error = static_cast<float>(random() % 5);
      if (random() % 20 == 0) error = std::array{-infinity, infinity, nan, -0.0F, 1e-42F}[random() % 5];
      faces = random() % 4;
    }
    const float least = random() % 2 == 0 ? 0 : std::uniform_real_distribution<float>(0, 4)(random);
    for (int i = 0; i < 20; ++i) {
      const uint64_t coarse = random() % 100;
      const uint64_t budget = coarse + random() % 400;
      ASSERT_EQ(threshold_within(edges, least, coarse, budget), by_sorting(edges, least, coarse, budget));
    }
  }
}

}  // namespace
}  // namespace papilio
