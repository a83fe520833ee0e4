#include "core/detail/vertex_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/detail/surface_distance.h"
#include "tests/support/bumpy_sphere.h"
#include "tests/support/collapse_optimally.h"
#include "tests/support/invariants.h"
#include "tests/support/shapes.h"

// Vertices of a simplified mesh moved nearer to its original, and onto a grid.

namespace papilio {
namespace {

constexpr uint32_t fit_samples = 20'000, measured_samples = 50'000;

double rms_between(const SurfaceTree& original, const TriangleMesh& mesh) {
  return surface_distance(original, SurfaceTree(mesh), measured_samples).rms;
}

double largest_between(const SurfaceTree& original, const TriangleMesh& mesh) {
  const SurfaceTree surface(mesh);
  return std::max(surface_distance(original, surface, fit_samples).largest, vertex_distance(original, surface));
}

TriangleMesh rounded_to(const PositionGrid& grid, TriangleMesh mesh) {
  const auto rounded = [&](float x, float origin) {
    return origin + grid.step * std::floor((x - origin) / grid.step + 0.5F);
  };
  for (Vec3f& p : mesh.positions)
    p = {rounded(p.x, grid.origin.x), rounded(p.y, grid.origin.y), rounded(p.z, grid.origin.z)};
  return mesh;
}

TEST(VertexFit, MovedVerticesAreNearer) {
  const SurfaceTree original(test::bumpy_sphere(4));
  const TriangleMesh simplified = test::collapse_optimally(original.surface(), 800, Quadrics::memoryless);
  VertexFit fit(original, simplified, fit_samples);
  EXPECT_EQ(fit.mesh(), simplified);
  fit.improve(2);
  EXPECT_TRUE(test::is_consistent(build_mesh(fit.mesh())));
  EXPECT_EQ(fit.mesh().triangles, simplified.triangles);
  EXPECT_LT(rms_between(original, fit.mesh()), 0.95 * rms_between(original, simplified));
}

TEST(VertexFit, GridPointsAreNearerThanTheNearestOnes) {
  const SurfaceTree original(test::bumpy_sphere(4));
  VertexFit fit(original, test::collapse_optimally(original.surface(), 800, Quadrics::memoryless), fit_samples);
  fit.improve(2);
  const double exact = rms_between(original, fit.mesh());
  const PositionGrid grid{.origin = {-2, -2, -2}, .step = static_cast<float>(4 * exact), .bits = 16};
  const TriangleMesh chosen = fit.on_grid(grid);
  EXPECT_TRUE(test::is_consistent(build_mesh(chosen)));
  const TriangleMesh again = rounded_to(grid, chosen);
  for (size_t v = 0; v < chosen.positions.size(); ++v)
    EXPECT_LT(length(chosen.positions[v] - again.positions[v]), 1e-3F * grid.step) << v;
  const auto excess = [&](const TriangleMesh& mesh) {
    const double rms = rms_between(original, mesh);
    return rms * rms - exact * exact;
  };
  EXPECT_LT(excess(chosen), 0.4 * excess(rounded_to(grid, fit.mesh())));
}

TEST(VertexFit, SharpEdgesAndBoundariesStay) {
  for (const TriangleMesh& mesh : {test::box({12, 12, 12}, {1, 2, 3}), test::grid(20, 20)}) {
    const SurfaceTree original(mesh);
    const TriangleMesh simplified = test::collapse_optimally(mesh, mesh.triangles.size() / 4, Quadrics::memoryless);
    VertexFit fit(original, simplified, fit_samples);
    fit.improve(2);
    const double diagonal = bounding_box(mesh.positions).diagonal();
    EXPECT_LT(vertex_distance(original, SurfaceTree(fit.mesh())), 1e-4 * diagonal);
  }
}

TEST(VertexFit, RetreatEndsWithinTheLargestDistance) {
  const SurfaceTree original(test::bumpy_sphere(4));
  for (const size_t faces : {200, 400, 800}) {
    const TriangleMesh simplified = test::collapse_optimally(original.surface(), faces, Quadrics::memoryless);
    const double most = largest_between(original, simplified);
    VertexFit fit(original, simplified, fit_samples);
    fit.improve(2);
    const double improved = rms_between(original, fit.mesh());
    EXPECT_GT(largest_between(original, fit.mesh()), most) << faces;
    fit.retreat(most);
    EXPECT_LE(largest_between(original, fit.mesh()), 1.0001 * most) << faces;
    EXPECT_LT(rms_between(original, fit.mesh()), 0.5 * (improved + rms_between(original, simplified))) << faces;
  }
}

TEST(VertexFit, CancellationStops) {
  const SurfaceTree original(test::bumpy_sphere(3));
  struct Stop {};
  VertexFit fit(original, test::collapse_optimally(original.surface(), 200), fit_samples, Poller([] { throw Stop(); }));
  EXPECT_THROW(fit.improve(1), Stop);
}

}  // namespace
}  // namespace papilio
