#include "core/detail/optimal_collapse.h"

#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "client/lib/compare.h"
#include "core/detail/quadric.h"
#include "core/detail/surface_distance.h"
#include "papilio/refine.h"
#include "tests/support/collapse_optimally.h"
#include "tests/support/invariants.h"
#include "tests/support/shapes.h"

namespace papilio::test {
namespace {

/// A sphere of radius 1: an octahedron split in four four times, with vertices moved to the sphere.
TriangleMesh fine_sphere() {
  Options options;
  options.levels = 4;
  TriangleMesh mesh = refine(build_mesh(octahedron()), options).mesh.triangles();
  for (Vec3f& p : mesh.positions) p = (1 / length(p)) * p;
  return mesh;
}

TriangleMesh by_meshoptimizer(const TriangleMesh& mesh, size_t faces) {
  TriangleMesh out;
  out.positions = mesh.positions;
  std::vector<uint32_t> indices(3 * mesh.triangles.size());
  const size_t count =
      meshopt_simplify(indices.data(), mesh.triangles.data()->data(), indices.size(), &mesh.positions.data()->x,
                       mesh.positions.size(), sizeof(Vec3f), 3 * faces, 1.0F, 0, nullptr);
  for (size_t i = 0; i < count; i += 3) out.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  return out;
}

double rms(const TriangleMesh& fine, const TriangleMesh& coarse) {
  return client::compare(fine, coarse, {.samples = 2000}).rms_forward;
}

TEST(Quadric, MinimumIsWherePlanesMeet) {
  const Vec3d corner{2, -3, 5};
  const Quadric sum = Quadric({1, 0, 0}, corner, 4) + Quadric({0, 0.6, 0.8}, corner, 1) + Quadric({0, 0, 1}, corner, 9);
  ASSERT_TRUE(sum.minimum());
  EXPECT_NEAR(length(*sum.minimum() - corner), 0, 1e-12);
  EXPECT_NEAR(sum.at(corner), 0, 1e-12);
  EXPECT_NEAR(sum.at({3, -3, 5}), 4, 1e-12) << "weight times squared distance to the other plane";
}

TEST(Quadric, ParallelPlanesHaveNoSingleMinimum) {
  EXPECT_FALSE((Quadric({0, 0, 1}, {0, 0, 1}, 1) + Quadric({0, 0, 1}, {0, 0, 2}, 1)).minimum());
  EXPECT_FALSE((Quadric({0, 0, 1}, {}, 1) + Quadric({1, 0, 0}, {}, 1)).minimum());
}

TEST(OptimalCollapse, FlatSquareBecomesTwoFacesWithoutError) {
  const TriangleMesh square = grid(12, 12);
  const TriangleMesh result = collapse_optimally(square, 2);
  EXPECT_EQ(result.triangles.size(), 2U);
  EXPECT_LT(client::compare(square, result, {.samples = 2000}).hausdorff, 1e-6);
}

TEST(OptimalCollapse, BoxBecomesTwelveFacesWithoutError) {
  const TriangleMesh fine = box({8, 6, 4}, {4, 3, 2});
  const TriangleMesh result = collapse_optimally(fine, 12);
  EXPECT_EQ(result.triangles.size(), 12U);
  EXPECT_LT(client::compare(fine, result, {.samples = 2000}).hausdorff, 1e-6);
}

TEST(OptimalCollapse, TopologyIsKept) {
  for (const auto& [mesh, euler] : {std::pair{fine_sphere(), 2}, std::pair{torus(40, 20), 0}}) {
    for (const size_t faces : {size_t{200}, size_t{60}}) {
      const TriangleMesh result = collapse_optimally(mesh, faces);
      EXPECT_EQ(result.triangles.size(), faces);
      const EdgeCensus edges = count_edges(result);
      EXPECT_EQ(edges.boundary, 0U);
      EXPECT_EQ(edges.irregular, 0U);
      EXPECT_EQ(euler_characteristic(result), euler);
    }
  }
}

TEST(OptimalCollapse, TetrahedronIsTheSmallestSphere) {
  EXPECT_EQ(collapse_optimally(fine_sphere(), 4).triangles.size(), 4U);
  EXPECT_THROW((void)collapse_optimally(fine_sphere(), 2), std::runtime_error);
}

TEST(OptimalCollapse, DistanceIsBelowHalfEdgeCollapses) {
  for (const TriangleMesh& mesh : {fine_sphere(), torus(60, 30)}) {
    const TriangleMesh halved = by_meshoptimizer(mesh, 300);
    ASSERT_GT(halved.triangles.size(), 200U);
    const TriangleMesh ours = collapse_optimally(mesh, halved.triangles.size());
    EXPECT_LE(ours.triangles.size(), halved.triangles.size());
    EXPECT_LT(rms(mesh, ours), 0.7 * rms(mesh, halved));
  }
}

TEST(OptimalCollapse, ResultsOfSeveralSizesEqualSingleRuns) {
  const TriangleMesh mesh = torus(40, 20);
  const std::vector<size_t> sizes = {1000, 400, 399, 60};
  for (const Quadrics quadrics : {Quadrics::accumulated, Quadrics::memoryless}) {
    const std::vector<TriangleMesh> results = collapse_to_sizes(mesh, sizes, quadrics);
    ASSERT_EQ(results.size(), sizes.size());
    for (size_t i = 0; i < sizes.size(); ++i)
      EXPECT_EQ(results[i], collapse_optimally(mesh, sizes[i], quadrics)) << sizes[i];
  }
}

TEST(OptimalCollapse, UnreachableSizesAreOmitted) {
  EXPECT_EQ(collapse_to_sizes(fine_sphere(), std::vector<size_t>{100, 4, 2}).size(), 2U);
}

TEST(OptimalCollapse, MemorylessQuadricsAreMoreAccurate) {
  const TriangleMesh mesh = torus(120, 60);
  EXPECT_LT(rms(mesh, collapse_optimally(mesh, 600, Quadrics::memoryless)),
            0.9 * rms(mesh, collapse_optimally(mesh, 600, Quadrics::accumulated)));
}

TEST(OptimalCollapse, MemorylessQuadricsKeepTheBoundary) {
  const TriangleMesh square = grid(12, 12);
  const TriangleMesh result = collapse_optimally(square, 2, Quadrics::memoryless);
  EXPECT_LT(client::compare(square, result, {.samples = 2000}).hausdorff, 1e-6);
}

TEST(OptimalCollapse, VerticesStayWithinTheLargestDistance) {
  TriangleMesh spiked = grid(20, 20);
  spiked.positions[210].z = 0.06F;
  const auto collapsed = [&](size_t faces, double largest) {
    return collapse_to_sizes(spiked, std::array{faces}, Quadrics::memoryless, {}, largest);
  };
  const auto farthest = [&](const TriangleMesh& mesh) {
    return vertex_distance(SurfaceTree(spiked), SurfaceTree(mesh));
  };
  const auto lost = collapsed(2, 1), kept = collapsed(40, 0.05);
  ASSERT_EQ(lost.size(), 1U);
  EXPECT_GT(farthest(lost[0]), 0.05);
  EXPECT_TRUE(collapsed(2, 0.05).empty());
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_LE(farthest(kept[0]), 0.05);
}

TEST(OptimalCollapse, PointsOfLargeLidsStayWithinTheLargestDistance) {
  const TriangleMesh tube = test::tube(500, 4, 0.5F, true);
  const auto made = collapse_to_sizes(tube, std::array<size_t, 1>{200}, Quadrics::memoryless, {}, 0.01);
  ASSERT_EQ(made.size(), 1U);
  EXPECT_LE(vertex_distance(SurfaceTree(tube), SurfaceTree(made[0])), 0.01);
}

TEST(OptimalCollapse, NonManifoldMeshIsSplitIntoSheets) {
  // Three squares that share an edge of five segments.
  TriangleMesh wings = grid(5, 5);
  for (const Vec3f side : {Vec3f{0, 0, 1}, Vec3f{-1, 0, 0}}) {
    const TriangleMesh flat = grid(5, 5);
    const auto first = static_cast<uint32_t>(wings.positions.size());
    for (const Vec3f p : flat.positions) wings.positions.push_back(p.x * side + Vec3f{0, p.y, 0});
    for (const auto& [a, b, c] : flat.triangles) wings.triangles.push_back({first + a, first + b, first + c});
  }
  ASSERT_GT(count_edges(build_mesh(wings).triangles()).irregular, 0U);
  const TriangleMesh result = collapse_optimally(wings, 6);
  EXPECT_EQ(result.triangles.size(), 6U);
  EXPECT_LT(client::compare(wings, result, {.samples = 2000}).hausdorff, 1e-6);
}

}  // namespace
}  // namespace papilio::test
