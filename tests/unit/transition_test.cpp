#include "core/hierarchy/transition.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

/// Returns the smallest angle of a face in degrees, by the law of cosines.
double smallest_angle_of(const Mesh& mesh, uint32_t face) {
  const auto corner = [&](uint32_t i) { return to_double(mesh.positions[mesh.topology.origin[3 * face + i % 3]]); };
  double smallest = 180;
  for (uint32_t i = 0; i < 3; ++i) {
    const Vec3d one = corner(i + 1) - corner(i);
    const Vec3d other = corner(i + 2) - corner(i);
    smallest = std::min(smallest, std::atan2(length(cross(one, other)), dot(one, other)) * 180 / std::numbers::pi);
  }
  return smallest;
}

TEST(SmallestAngle, AngleEqualsTheSmallestOfAllFacesAtAnyScale) {
  std::mt19937 random(13);
  for (int i = 0; i < 400; ++i) {
    const float size = std::pow(10.0F, std::uniform_real_distribution<float>(-14, 14)(random));
    TriangleMesh triangles = random_manifold(random);
    for (Vec3f& p : triangles.positions) p = {size * p.x, size * p.y, size * (i % 2 == 0 ? 0.1F : 1) * p.z};
    const Mesh mesh = build_mesh(triangles);
    double smallest = 180;
    for (uint32_t f = 0; f < mesh.topology.face_count(); ++f) smallest = std::min(smallest, smallest_angle_of(mesh, f));
    EXPECT_NEAR(smallest_angle(mesh) * 180 / std::numbers::pi, smallest, 1e-5);
  }
}

}  // namespace
}  // namespace papilio
