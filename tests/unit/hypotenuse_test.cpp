#include "core/base/hypotenuse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/support/rounding.h"

// Compared with the standard library's long double and with exact values.

namespace papilio {
namespace {

using test::error_in_units;

TEST(Hypotenuse, ErrorIsBelow51HundredthsOfAnUlp) {
  EXPECT_EQ(hypotenuse(3, -4), 5);
  EXPECT_EQ(hypotenuse(0, 0), 0);
  EXPECT_EQ(hypotenuse(0, -2), 2);
  EXPECT_EQ(hypotenuse(3e300, 4e300), 5e300);
  EXPECT_DOUBLE_EQ(hypotenuse(3e-310, 4e-310), 5e-310);
  EXPECT_EQ(hypotenuse(std::numeric_limits<double>::infinity(), 1), std::numeric_limits<double>::infinity());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(-1, 1);
  for (int i = 0; i < 20000; ++i) {
    const int exponent = static_cast<int>(random() % 2000) - 1000;
    const double x = std::ldexp(share(random), exponent);
    const double y = std::ldexp(share(random), exponent - static_cast<int>(random() % 70));
    EXPECT_LT(error_in_units(hypotenuse(x, y), std::hypot(static_cast<long double>(x), static_cast<long double>(y))),
              0.51);
  }
}

}  // namespace
}  // namespace papilio
