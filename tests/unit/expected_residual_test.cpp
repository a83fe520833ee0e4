#include "core/detail/expected_residual.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace papilio {
namespace {

int32_t whole_number(std::mt19937& random, int32_t most) {
  return static_cast<int32_t>(random() % (2 * static_cast<uint32_t>(most) + 1)) - most;
}

ResidualContext random_inputs(std::mt19937& random) {
  ResidualContext c{.level = 2, .known = 1};
  c.neighbours[0] = whole_number(random, 20);
  c.ends = whole_number(random, 20);
  c.sibling = whole_number(random, 20);
  c.beyond = whole_number(random, 20);
  c.bow = whole_number(random, 20);
  return c;
}

TEST(ExpectedResidual, NothingIsExpectedOfNothing) {
  ExpectedResidual expected;
  EXPECT_EQ(expected.at({.level = 1}), 0);
  EXPECT_EQ(expected.at({.level = 7, .known = most_neighbours}), 0);
}

// The weights of real models: residuals have the sign of their neighbours; half-way between others that are coded, the
// opposite one; coarse levels are predicted too round.
TEST(ExpectedResidual, SignsAreThoseOfRealModelsAtFirst) {
  ExpectedResidual expected;
  EXPECT_GT(expected.at({.level = 3, .neighbours = {5, 0, 0, 0}, .known = 1}), 0);
  EXPECT_GT(expected.at({.level = 3, .known = 1, .ends = 5}), 0);
  EXPECT_LT(expected.at({.level = 3, .known = 1, .sibling = 5}), 0);
  EXPECT_LT(expected.at({.level = 3, .known = 4, .beyond = 5}), 0);
  EXPECT_LT(expected.at({.level = 1, .known = 2, .bow = 5}), 0);
}

TEST(ExpectedResidual, AnyLinearRelationIsLearnt) {
  std::mt19937 random(1);
  ExpectedResidual expected;
  double squared_error = 0;
  for (int i = 0; i < 20'000; ++i) {
    const ResidualContext c = random_inputs(random);
    const double relation = -0.5 * c.neighbours[0] + 0.25 * static_cast<double>(c.ends) + 0.5 * c.sibling +
                            0.125 * static_cast<double>(c.beyond) + 0.75 * c.bow;
    const double error = expected.at(c) - relation;
    expected.update(static_cast<int32_t>(std::lround(relation)));
    if (i >= 19'000) squared_error += error * error;
  }
  EXPECT_LT(std::sqrt(squared_error / 1000), 1);
}

TEST(ExpectedResidual, LevelsAndNumbersOfNeighboursLearnApart) {
  const ResidualContext other{.level = 3, .neighbours = {1, 1, 1, 1}, .known = 4};
  ExpectedResidual expected;
  const double before = expected.at(other);
  std::mt19937 random(2);
  for (int i = 0; i < 1000; ++i) {
    (void)expected.at(random_inputs(random));
    expected.update(whole_number(random, 50));
  }
  EXPECT_EQ(expected.at(other), before);
}

TEST(ExpectedResidual, StaysWithinBoundsForAnyResiduals) {
  std::mt19937 random(3);
  ExpectedResidual expected;
  for (int i = 0; i < 100'000; ++i) {
    ResidualContext c{.level = static_cast<uint32_t>(random() % 12), .known = static_cast<uint32_t>(random() % 5)};
    for (uint32_t n = 0; n < c.known; ++n)
      c.neighbours[n] = random() % 2 == 0 ? 1 : whole_number(random, largest_residual);
    c.ends = random() % 2 == 0 ? 1 : whole_number(random, 2 * largest_residual);
    c.beyond = whole_number(random, 8 * largest_residual);
    c.bow = random() % 2 == 0 ? 1e6 : -1e6;
    const double at = expected.at(c);
    ASSERT_LE(std::abs(at), largest_residual);
    expected.update(random() % 2 == 0 ? largest_residual : -largest_residual);
  }
}

}  // namespace
}  // namespace papilio
