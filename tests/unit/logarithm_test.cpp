#include "proto/edgebreaker/logarithm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/rounding.h"

// Compared with the standard library's long double.

namespace papilio::proto::edgebreaker {
namespace {

using test::error_in_units;

TEST(Logarithm, ErrorIsBelowThreeUlp) {
  for (int exponent = -30; exponent <= 30; ++exponent)
    EXPECT_EQ(logarithm_to_base_2(std::ldexp(1.0, exponent)), exponent);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 20000; ++i) {
    const double x = i % 2 == 0 ? share(random) : std::ldexp(share(random), static_cast<int>(random() % 100) - 50);
    EXPECT_LT(error_in_units(logarithm_to_base_2(x), std::log2(static_cast<long double>(x))), 3) << x;
  }
}

}  // namespace
}  // namespace papilio::proto::edgebreaker
