#include "core/rules/stencil.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

namespace papilio::stencil {
namespace {

constexpr double tolerance = 1e-13;

double sum(const std::vector<double>& weights) { return std::accumulate(weights.begin(), weights.end(), 0.0); }

/// Returns the explicit weights of a spoke of a vertex on a curve: the centre, then c_0..c_K.
std::vector<double> curve_weights(uint32_t triangles, uint32_t spoke) {
  const CurveRule rules(triangles);
  const CurveSpoke rule = rules.spoke(spoke);
  std::vector<double> weights{rule.centre, rule.end};
  for (uint32_t j = 1; j < triangles; ++j)
    weights.push_back(rule.sine_1 * rules.sine(j) + rule.sine_2 * rules.sine(2 * j));
  weights.push_back(-rule.end);
  return weights;
}

TEST(Stencil, RegularRuleSumsToOneForEveryW) {
  for (double w : {-0.0625, 0.0, 1.0 / 64, 0.125}) {
    const Regular<double> rule(w);
    EXPECT_NEAR(2 * rule.end + 2 * rule.apex + 4 * rule.wing + 2 * rule.far, 1, tolerance);
  }
  EXPECT_EQ(Regular<double>(0).far, 0);
}

TEST(Stencil, CurveRowsSumToOne) {
  EXPECT_EQ(2 * Curve<double>::end + 2 * Curve<double>::next, 1);
  using Row = InteriorCurve<double>;
  EXPECT_EQ(Row::a + Row::b + Row::p + Row::q + Row::b_next + Row::wing_ap + Row::wing_aq, 1);
  using Inner = CurveCurve<double>;
  EXPECT_EQ(2 * Inner::end + Inner::apex + 2 * Inner::wing, 1);
}

TEST(Stencil, InteriorRowsSumToOneAndReproduceLinearFunctions) {
  for (uint32_t k = 3; k <= 64; ++k) {
    const Interior rule = interior(k);
    EXPECT_NEAR(rule.centre + sum(rule.ring), 1, tolerance) << k;
    double x = 0;
    double y = 0;
    for (uint32_t j = 0; j < k; ++j) {
      x += rule.ring[j] * std::cos(2 * std::numbers::pi * j / k);
      y += rule.ring[j] * std::sin(2 * std::numbers::pi * j / k);
    }
    EXPECT_NEAR(x, 0.5, tolerance) << k;  // half way to neighbour 0 at (1, 0)
    EXPECT_NEAR(y, 0, tolerance) << k;
  }
  EXPECT_EQ(interior(2).centre + sum(interior(2).ring), 1);
}

TEST(Stencil, GeneralFormulaDiffersAtValenceSix) {
  const Interior rule = interior(regular_valence);
  EXPECT_GT(std::abs(rule.centre - Regular<double>(0).end), 0.1);
}

TEST(Stencil, CurveVertexRowsSumToOneAndReproduceLinearFunctions) {
  for (uint32_t k = 2; k <= 64; ++k) {
    for (uint32_t i = 1; i < k; ++i) {
      const std::vector<double> rule = curve_weights(k, i);
      ASSERT_EQ(rule.size(), k + 2);
      EXPECT_NEAR(sum(rule), 1, tolerance) << k << ' ' << i;
      // The half disc: neighbour j at angle j pi / K.
      double x = 0;
      double y = 0;
      for (uint32_t j = 0; j <= k; ++j) {
        x += rule[1 + j] * std::cos(std::numbers::pi * j / k);
        y += rule[1 + j] * std::sin(std::numbers::pi * j / k);
      }
      EXPECT_NEAR(x, std::cos(std::numbers::pi * i / k) / 2, tolerance) << k << ' ' << i;
      EXPECT_NEAR(y, std::sin(std::numbers::pi * i / k) / 2, tolerance) << k << ' ' << i;
    }
  }
}

TEST(Stencil, CurveVertexRowsAreAccurateAtHugeValence) {
  for (uint32_t k : {10'000U, 1'000'000U}) {
    for (uint32_t i : {1U, k / 3, k - 1}) EXPECT_NEAR(sum(curve_weights(k, i)), 1, 1e-8) << k << ' ' << i;
  }
}

TEST(Stencil, CurveVertexRuleIsSymmetric) {
  for (uint32_t k = 2; k <= 12; ++k) {
    for (uint32_t i = 1; i < k; ++i) {
      const std::vector<double> rule = curve_weights(k, i);
      const std::vector<double> mirrored = curve_weights(k, k - i);
      EXPECT_NEAR(rule[0], mirrored[0], tolerance);
      for (uint32_t j = 0; j <= k; ++j) EXPECT_NEAR(rule[1 + j], mirrored[1 + k - j], tolerance);
    }
  }
}

}  // namespace
}  // namespace papilio::stencil
