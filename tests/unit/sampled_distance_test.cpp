#include "tests/support/sampled_distance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "papilio/refine.h"
#include "tests/support/shapes.h"

namespace papilio::test {
namespace {

/// An octahedron split in four `levels` times, with vertices on the sphere.
TriangleMesh sphere(int levels, float radius) {
  TriangleMesh mesh = octahedron();
  for (int level = 0; level < levels; ++level) {
    mesh = refine(build_mesh(mesh), {.levels = 1}).mesh.triangles();
    for (Vec3f& p : mesh.positions) p = (1 / length(p)) * p;
  }
  for (Vec3f& p : mesh.positions) p = radius * p;
  return mesh;
}

TriangleMesh moved(TriangleMesh mesh, Vec3f by) {
  for (Vec3f& p : mesh.positions) p += by;
  return mesh;
}

TEST(SampledDistance, SurfaceHasZeroDistanceToItself) {
  const SampledDistance found = SampledSurface(torus(20, 10)).distance_to(torus(20, 10));
  EXPECT_LT(found.largest, 1e-6);
}

TEST(SampledDistance, ParallelSquaresHaveTheDistanceOfTheirPlanes) {
  const TriangleMesh square = grid(4, 4);
  const SampledDistance found = SampledSurface(square).distance_to(moved(square, {0, 0, 0.25F}));
  const double percent = 100 * 0.25 / std::sqrt(32.0);
  EXPECT_NEAR(found.rms, percent, 1e-6);
  EXPECT_NEAR(found.largest, percent, 1e-6);
}

TEST(SampledDistance, SquareMovedInItsPlaneDiffersByItsOverhang) {
  // The overhang is 1/8 of the area at distances of 0 to 1/2: the mean square is 1/8 * 1/12.
  const TriangleMesh square = grid(4, 4);
  const SampledDistance found = SampledSurface(square).distance_to(moved(square, {0.5F, 0, 0}));
  EXPECT_NEAR(found.rms, 100 * std::sqrt(1.0 / 96) / std::sqrt(32.0), 0.02);
  EXPECT_NEAR(found.largest, 100 * 0.5 / std::sqrt(32.0), 0.02);
}

TEST(SampledDistance, DistanceCoversBothDirections) {
  const TriangleMesh square = grid(4, 4);
  const TriangleMesh both = join(square, square, 100);
  EXPECT_NEAR(SampledSurface(both).distance_to(square).largest, 100 * 100 / std::hypot(104, 4), 0.1)
      << "a part is missing";
  EXPECT_GT(SampledSurface(square).distance_to(both).largest, 1000) << "a part is superfluous";
}

TEST(SampledDistance, ConcentricSpheresDifferByTheirRadii) {
  const SampledDistance found = SampledSurface(sphere(6, 1)).distance_to(sphere(6, 1.01F));
  EXPECT_NEAR(found.rms, 100 * 0.01 / std::sqrt(12.0), 0.003);
  EXPECT_NEAR(found.largest, 100 * 0.01 / std::sqrt(12.0), 0.015);
}

TEST(SampledDistance, SamplesHaveEqualSharesOfTheArea) {
  const std::vector<TriangleCorners> triangles = {
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{5, 0, 0}, {5, 0, 0}, {5, 1, 0}}, {{9, 0, 0}, {12, 0, 0}, {9, 1, 0}}};
  size_t first = 0;
  const std::vector<Vec3d> samples = sample_by_area(triangles, 1000);
  for (const Vec3d p : samples) first += p.x <= 1 ? 1 : 0;
  EXPECT_EQ(samples.size(), 1000U);
  EXPECT_EQ(first, 250U);
}

TEST(SampledDistance, SurfaceWithoutAreaHasNoSamples) {
  EXPECT_TRUE(sample_by_area(std::vector<TriangleCorners>{{{1, 0, 0}, {2, 0, 0}, {3, 0, 0}}}, 10).empty());
}

}  // namespace
}  // namespace papilio::test
