#include "tests/support/rate_curve.h"

#include <gtest/gtest.h>

namespace papilio::test {
namespace {

TEST(RateCurve, EnvelopeOmitsDominatedPoints) {
  const std::vector<RatePoint> envelope = lower_envelope(
      {{.bytes = 400, .rms = 1}, {.bytes = 100, .rms = 4}, {.bytes = 200, .rms = 5}, {.bytes = 400, .rms = 2}});
  ASSERT_EQ(envelope.size(), 2U);
  EXPECT_EQ(envelope[0].bytes, 100);
  EXPECT_EQ(envelope[1].bytes, 400);
  EXPECT_EQ(envelope[1].rms, 1);
}

TEST(RateCurve, EnvelopeOmitsPointsAboveALine) {
  // The line from (100, 1.44) to (144, 1) passes through (120, 1.2) in logarithms.
  const auto count = [](double middle) {
    return lower_envelope({{.bytes = 100, .rms = 1.44}, {.bytes = middle, .rms = 1.2}, {.bytes = 144, .rms = 1}})
        .size();
  };
  EXPECT_EQ(count(121), 2U);
  EXPECT_EQ(count(119), 3U);
}

TEST(RateCurve, EnvelopeIsConvexInLogarithms) {
  EXPECT_EQ(lower_envelope({{.bytes = 100, .rms = 4}, {.bytes = 300, .rms = 2}, {.bytes = 400, .rms = 1}}).size(), 3U);
}

TEST(RateCurve, InterpolationIsLogarithmic) {
  const std::vector<RatePoint> envelope =
      lower_envelope({{.bytes = 100, .rms = 4, .largest = 18}, {.bytes = 400, .rms = 1, .largest = 2}});
  const auto middle = at_rms(envelope, 2);
  ASSERT_TRUE(middle);
  EXPECT_NEAR(middle->bytes, 200, 1e-9);
  EXPECT_NEAR(middle->largest, 6, 1e-9);
  EXPECT_EQ(middle->rms, 2);
  EXPECT_NEAR(at_rms(envelope, 1)->bytes, 400, 1e-9);
}

TEST(RateCurve, SmallestPointMeetsLargerDistances) {
  const auto found = at_rms({{.bytes = 100, .rms = 4}}, 5);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->bytes, 100);
  EXPECT_EQ(found->rms, 4);
}

TEST(RateCurve, DistanceBelowTheNearestPointIsUnreachable) {
  EXPECT_FALSE(at_rms({{.bytes = 100, .rms = 4}}, 3));
  EXPECT_FALSE(at_rms({}, 3));
}

TEST(RateCurve, PointOfZeroDistanceIsInterpolated) {
  const auto found = at_rms({{.bytes = 100, .rms = 4, .largest = 8}, {.bytes = 200, .rms = 0}}, 0.001);
  ASSERT_TRUE(found);
  EXPECT_LE(found->bytes, 200);
  EXPECT_GE(found->largest, 0);
}

}  // namespace
}  // namespace papilio::test
