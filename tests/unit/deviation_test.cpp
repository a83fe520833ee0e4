#include "core/criteria/deviation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "papilio/triangle_distance.h"

// The fast distance to two triangles against the distances to each of them.

namespace papilio {
namespace {

class RandomPoints {
 public:
  Vec3f in_box(float size) { return {size * share(), size * share(), size * share()}; }
  float share() { return uniform_(random_); }

 private:
  std::mt19937 random_{5};
  std::uniform_real_distribution<float> uniform_{-1, 1};
};

double by_triangles(Vec3f q, Vec3f a, Vec3f b, Vec3f apex, Vec3f other_apex) {
  const auto squared = [&](Vec3f c) {
    return squared_distance(to_double(q), {to_double(a), to_double(b), to_double(c)});
  };
  return std::sqrt(std::min(squared(apex), squared(other_apex)));
}

TEST(Deviation, DeviationIsTheDistanceToTheNearerFace) {
  RandomPoints points;
  int above_none = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3f a = points.in_box(1);
    const Vec3f b = points.in_box(1);
    const Vec3f apex = points.in_box(1);
    const Vec3f other_apex = points.in_box(1);
    // Near the middle of the edge, where new vertices are; now and then far away.
    const Vec3f q = 0.5F * (a + b) + points.in_box(i % 10 == 0 ? 2 : 0.2F);
    const double expected = by_triangles(q, a, b, apex, other_apex);
    ASSERT_NEAR(deviation_from_faces(q, a, b, apex, other_apex), expected, 1e-7) << i;
    const double to_edge = std::sqrt(squared_distance_to_segment(to_double(q), to_double(a), to_double(b)));
    above_none += std::abs(expected - to_edge) < 1e-12 ? 1 : 0;
  }
  EXPECT_GT(above_none, 500);  // cases in which the edge is nearest
}

TEST(Deviation, DeviationNeverExceedsTheDistanceToTheMidpoint) {
  // Nearly flat faces and a vertex near the midpoint: rounding errors are as large as the distances.
  RandomPoints points;
  for (int i = 0; i < 20000; ++i) {
    const float height = i % 2 == 0 ? 1e-7F : 0;
    const auto flat = [&] { return Vec3f{points.share(), points.share(), height * points.share()}; };
    const Vec3f a = flat();
    const Vec3f b = flat();
    const Vec3f q = 0.5F * (a + b) + height * flat();
    const double most = length(to_double(q) - 0.5 * (to_double(a) + to_double(b)));
    ASSERT_LE(deviation_from_faces(q, a, b, flat(), flat()), most) << i;
  }
}

TEST(Deviation, PointInAFaceHasZeroDeviation) {
  RandomPoints points;
  for (int i = 0; i < 1000; ++i) {
    const float x = 0.5F + 0.4F * points.share();
    EXPECT_EQ(deviation_from_faces({x, 0.01F, 0}, {0, 0, 0}, {1, 0, 0}, {0.5F, 1, 0}, {0.5F, -1, 1}), 0);
    EXPECT_EQ(deviation_from_faces({x, 0.01F, 0}, {0, 0, 0}, {1, 0, 0}, {0.5F, -1, 1}, {0.5F, 1, 0}), 0);
  }
}

TEST(Deviation, DegenerateFacesAreMeasuredAsSegments) {
  // Both triangles have no area: they are segments.
  EXPECT_DOUBLE_EQ(deviation_from_faces({0.5F, 2, 0}, {0, 0, 0}, {1, 0, 0}, {0.5F, 0, 0}, {2, 0, 0}), 2);
  EXPECT_DOUBLE_EQ(deviation_from_faces({4, 4, 0}, {0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0, 0}), 5);
}

}  // namespace
}  // namespace papilio
