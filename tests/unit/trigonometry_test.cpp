#include "core/base/trigonometry.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tests/support/rounding.h"

// Compared with the standard library's long double and with exact values.

namespace papilio {
namespace {

using test::error_in_units;

constexpr long double pi = std::numbers::pi_v<long double>;

TEST(Trigonometry, QuartersAndSixthsOfATurnAreExact) {
  for (uint64_t times : {1, 7, 1000}) {
    EXPECT_EQ(sine_of_turn(0, 4 * times), 0);
    EXPECT_EQ(cosine_of_turn(times, 4 * times), 0);
    EXPECT_EQ(sine_of_turn(times, 4 * times), 1);
    EXPECT_EQ(cosine_of_turn(2 * times, 4 * times), -1);
    EXPECT_EQ(sine_of_turn(3 * times, 4 * times), -1);
    EXPECT_EQ(cosine_of_turn(times, 6 * times), 0.5);
    EXPECT_EQ(cosine_of_turn(2 * times, 6 * times), -0.5);
    EXPECT_EQ(sine_of_turn(7 * times, 12 * times), -0.5);
    EXPECT_EQ(tangent_of_turn(times, 8 * times), 1);
  }
  EXPECT_EQ(cosine_of_degrees(90), 0);
  EXPECT_EQ(cosine_of_degrees(60), 0.5);
  EXPECT_EQ(cosine_of_degrees(120), -0.5);
  EXPECT_EQ(cosine_of_degrees(180), -1);
  EXPECT_EQ(tangent_of_degrees(45), 1);
  EXPECT_EQ(arc_cosine(1), 0);
  EXPECT_EQ(arc_cosine(0), std::numbers::pi / 2);
}

TEST(Trigonometry, ErrorsForTurnsAreBelow55HundredthsOfAnUlp) {
  int wrong = 0;
  int count = 0;
  for (uint64_t whole = 1; whole <= 400; ++whole)
    for (uint64_t part = 0; part < 2 * whole; ++part) {
      if (8 * part % whole == 0) continue;  // exact results: pi as a long double is too inaccurate
      const long double angle = 2 * pi * static_cast<long double>(part) / static_cast<long double>(whole);
      const SineCosine found = sine_and_cosine_of_turn(part, whole);
      // Near a quarter of a turn the long double's angle is inaccurate.
      ASSERT_NEAR(found.sine, std::sin(angle), 3e-16) << part << " of " << whole;
      ASSERT_NEAR(found.cosine, std::cos(angle), 3e-16) << part << " of " << whole;
      if (8 * part >= whole) continue;
      EXPECT_LT(error_in_units(found.sine, std::sin(angle)), 0.55) << part << " of " << whole;
      EXPECT_LT(error_in_units(found.cosine, std::cos(angle)), 0.55) << part << " of " << whole;
      EXPECT_LT(error_in_units(tangent_of_turn(part, whole), std::tan(angle)), 0.55) << part << " of " << whole;
      wrong += found.sine != static_cast<double>(std::sin(angle)) ? 1 : 0;
      ++count;
    }
  EXPECT_LT(wrong, count / 100);
}

TEST(Trigonometry, SymmetricTurnsAreBitIdentical) {
  for (uint64_t whole = 1; whole <= 100; ++whole) {
    const std::vector<SineCosine> all = sines_and_cosines_of_turn(whole, whole);
    for (uint64_t part = 0; part <= whole; ++part) {
      EXPECT_EQ(sine_of_turn(part, whole), all[part % whole].sine);
      EXPECT_EQ(cosine_of_turn(part, whole), all[part % whole].cosine);
      EXPECT_EQ(sine_of_turn(part, whole), -sine_of_turn(whole - part, whole));
      EXPECT_EQ(cosine_of_turn(part, whole), cosine_of_turn(whole - part, whole));
      EXPECT_EQ(sine_of_turn(part, whole), sine_of_turn(3 * part, 3 * whole));
      EXPECT_EQ(sine_of_turn(4 * part + whole, 4 * whole), cosine_of_turn(part, whole));
    }
  }
}

TEST(Trigonometry, ErrorsForDegreesAreBelowSixTenthsOfAnUlp) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> degrees(0, 180);
  for (int i = 0; i < 20000; ++i) {
    const double angle = degrees(random);
    const long double exact = std::cos(angle * pi / 180);
    if (std::abs(angle - 90) > 1) {
      EXPECT_LT(error_in_units(cosine_of_degrees(angle), exact), 0.55) << angle;
    }
    EXPECT_NEAR(cosine_of_degrees(angle), static_cast<double>(exact), 2e-16) << angle;
    const double half = 0.495 * angle;
    EXPECT_LT(error_in_units(tangent_of_degrees(half), std::tan(half * pi / 180)), 0.6) << half;
    const double small = angle / 240;
    EXPECT_LT(error_in_units(cosine_of_small_angle(small), std::cos(static_cast<long double>(small))), 0.55) << small;
  }
}

TEST(Trigonometry, ArcCosineIsWithinOneUlp) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 20000; ++i) {
    double cosine = share(random);
    if (i % 2 == 0) cosine = 1 - std::ldexp(cosine, -static_cast<int>(random() % 53));
    EXPECT_LT(error_in_units(arc_cosine(cosine), std::acos(static_cast<long double>(cosine))), 1) << cosine;
  }
}

}  // namespace
}  // namespace papilio
