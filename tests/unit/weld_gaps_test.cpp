#include "core/mesh/weld_gaps.h"

#include <gtest/gtest.h>

#include <random>

#include "papilio/refine.h"
#include "tests/support/invariants.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

/// Returns the mesh with separate corners per face, moved by up to `noise` in each coordinate.
TriangleMesh torn(const TriangleMesh& mesh, float noise, uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> move(-noise, noise);
  TriangleMesh apart;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<uint32_t>(apart.positions.size());
    apart.triangles.push_back({first, first + 1, first + 2});
    for (const uint32_t p : t)
      apart.positions.push_back(mesh.positions[p] + Vec3f{move(random), move(random), move(random)});
  }
  return apart;
}

double diagonal_of(const TriangleMesh& mesh) { return bounding_box(mesh.positions).diagonal(); }

TEST(WeldGaps, TornSurfacesAreClosed) {
  for (const TriangleMesh& shape : {icosahedron(), cube(), torus(24, 16), box({4, 4, 1}, {1, 1, 0.1F})})
    for (uint32_t seed = 0; seed < 5; ++seed) {
      const TriangleMesh soup = torn(shape, static_cast<float>(2e-7 * diagonal_of(shape)), seed);
      BuildReport open, found;
      (void)build_mesh(soup, &open);
      EXPECT_GT(open.boundary_edges, 0U);
      const Mesh mesh = build_mesh(soup, &found, rounding_gap);
      const Mesh whole = build_mesh(shape);
      EXPECT_EQ(found.boundary_edges + found.non_manifold_edges + found.misoriented_edges + found.pinched_vertices, 0U);
      EXPECT_EQ(mesh.topology.face_count(), whole.topology.face_count());
      EXPECT_EQ(mesh.topology.euler_characteristic(), whole.topology.euler_characteristic());
      EXPECT_EQ(mesh.topology.vertex_count + found.near_duplicates, build_mesh(soup).topology.vertex_count);
      EXPECT_EQ(mesh.topology.origin, whole.topology.origin);
    }
}

TEST(WeldGaps, ZeroGapWeldsNothing) {
  const TriangleMesh soup = torn(icosahedron(), 1e-4F);
  EXPECT_EQ(build_mesh(soup, nullptr, rounding_gap).topology.vertex_count, build_mesh(soup).topology.vertex_count);
  for (const TriangleMesh& shape : {grid(6, 5), fan(7, false), cube(), square_ring(24, 0.6F, 1, 0.5F)}) {
    BuildReport exact, found;
    const Mesh one = build_mesh(shape, &exact), other = build_mesh(shape, &found, rounding_gap);
    EXPECT_EQ(one.topology.origin, other.topology.origin);
    EXPECT_EQ(one.topology.twin, other.topology.twin);
    EXPECT_EQ(one.topology.edge, other.topology.edge);
    EXPECT_EQ(one.positions, other.positions);
    EXPECT_EQ(found.near_duplicates, 0U);
    EXPECT_EQ(found.boundary_edges, exact.boundary_edges);
  }
}

/// Random triangles, most with corners close to others.
TriangleMesh random_triangles(std::mt19937& random) {
  const auto below = [&](uint32_t end) { return static_cast<uint32_t>(random() % end); };
  TriangleMesh mesh;
  for (uint32_t p = 0; p < 40; ++p) {
    const auto coordinate = [&] { return static_cast<float>(below(3)) + 1e-3F * static_cast<float>(below(4)); };
    mesh.positions.push_back({coordinate(), coordinate(), coordinate()});
  }
  while (mesh.triangles.size() < 60) mesh.triangles.push_back({below(40), below(40), below(40)});
  return mesh;
}

/// Two unit squares side by side, the second moved along x.
TriangleMesh two_squares(float apart) {
  const float x = 1 + apart;
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {x, 0, 0}, {2, 0, 0}, {2, 1, 0}, {x, 1, 0}},
          {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}};
}

TEST(WeldGaps, LowestNumberedVertexIsKept) {
  BuildReport found;
  const Mesh mesh = build_mesh(two_squares(1e-6F), &found, rounding_gap);
  EXPECT_EQ(found.near_duplicates, 2U);
  EXPECT_EQ(found.boundary_edges, 6U);
  EXPECT_EQ(mesh.topology.vertex_count, 6U);
  for (const Vec3f p : {Vec3f{1, 0, 0}, Vec3f{1, 1, 0}}) EXPECT_EQ(std::ranges::count(mesh.positions, p), 1);
}

TEST(WeldGaps, GapScalesWithTheDiagonal) {
  for (const float scale : {1e-6F, 1.F, 1e6F})
    for (const auto& [apart, welded] : {std::pair{1e-6F, 2U}, {4e-6F, 0U}}) {
      TriangleMesh mesh = two_squares(apart);
      for (Vec3f& p : mesh.positions) p = scale * p;
      BuildReport found;
      (void)build_mesh(mesh, &found, rounding_gap);
      EXPECT_EQ(found.near_duplicates, welded) << scale << " " << apart;
    }
}

TEST(WeldGaps, VerticesWithoutACommonEdgeStayApart) {
  TriangleMesh mesh = two_squares(0);
  for (uint32_t p : {4, 5, 6, 7}) mesh.positions[p] += Vec3f{1e-6F, 1 + 1e-6F, 0};  // touching at one corner
  BuildReport found;
  EXPECT_EQ(build_mesh(mesh, &found, rounding_gap).topology.vertex_count, 8U);
  EXPECT_EQ(found.pinched_vertices, 0U);
}

TEST(WeldGaps, EdgesOfEqualDirectionStayApart) {
  TriangleMesh mesh = two_squares(1e-6F);
  std::swap(mesh.triangles[2][0], mesh.triangles[2][1]);  // the second square faces down
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  BuildReport found;
  EXPECT_EQ(build_mesh(mesh, &found, rounding_gap).topology.vertex_count, 8U);
  EXPECT_EQ(found.misoriented_edges, 0U);
}

TEST(WeldGaps, ThirdSheetStaysApart) {
  TriangleMesh mesh = two_squares(1e-6F);
  for (const Vec3f p : {Vec3f{1, 0, 1e-6F}, {1, 1, 1e-6F}, {1, 0, 1}}) mesh.positions.push_back(p);
  mesh.triangles.push_back({9, 8, 10});
  BuildReport found;
  (void)build_mesh(mesh, &found, rounding_gap);
  EXPECT_EQ(found.near_duplicates, 2U);
  EXPECT_EQ(found.non_manifold_edges + found.misoriented_edges + found.pinched_vertices, 0U);
}

TEST(WeldGaps, ThinFacesKeepTheirCornersAndTheirSide) {
  // A strip narrower than the gap between two squares: its long sides are welded to the squares, not to each other.
  const float w = 5e-7F;
  TriangleMesh mesh{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1 + 2 * w, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1 + 2 * w, 1, 0}},
      {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}, {1, 4, 7}, {1, 7, 2}}};
  BuildReport found;
  const Mesh built = build_mesh(mesh, &found, 1e-5);
  EXPECT_EQ(built.topology.face_count(), 6U);
  EXPECT_EQ(found.near_duplicates, 0U);
  std::mt19937 random(3);
  for (int i = 0; i < 60; ++i) {  // welding adds no defects
    const TriangleMesh soup = random_triangles(random);
    for (const double gap : {1e-3, 1e-2, 0.1, 0.5}) {
      BuildReport exact, close;
      const Mesh before = build_mesh(soup, &exact);
      const Mesh after = build_mesh(soup, &close, gap);
      EXPECT_EQ(before.topology.face_count() + close.t_junctions, after.topology.face_count());
      EXPECT_LE(close.non_manifold_edges, exact.non_manifold_edges);
      EXPECT_LE(close.misoriented_edges, exact.misoriented_edges);
      EXPECT_LE(close.pinched_vertices, exact.pinched_vertices);
      EXPECT_LE(close.boundary_edges, exact.boundary_edges);
      EXPECT_EQ(close.degenerate_faces, exact.degenerate_faces);
    }
  }
}

TEST(WeldGaps, ChartsOfWeldedVerticesStayApart) {
  TriangleMesh mesh = two_squares(1e-6F);
  Attribute charts{.components = 1, .values = {0, 1, 1, 0, 5, 6, 6, 5}};
  mesh.attributes.push_back(charts);
  const Mesh apart = build_mesh(mesh, nullptr, rounding_gap);
  EXPECT_EQ(apart.topology.vertex_count, 6U);
  EXPECT_EQ(apart.attributes.point_count, 8U);
  mesh.attributes[0].values = {0, 1, 1, 0, 1, 2, 2, 1};
  EXPECT_EQ(build_mesh(mesh, nullptr, rounding_gap).attributes.point_count, 6U);
}

TEST(WeldGaps, CrowdedVerticesTakeBoundedTime) {
  // Nearly all vertices are within the gap of each other: vertices beyond the work limit are unchanged.
  TriangleMesh crowd = torn(grid(120, 120), 1e-4F);
  for (Vec3f& p : crowd.positions) p = 1e-9F * p;
  crowd.positions.push_back({1, 1, 1});
  crowd.positions.push_back({1, 0, 1});
  crowd.triangles.push_back(
      {0, static_cast<uint32_t>(crowd.positions.size() - 2), static_cast<uint32_t>(crowd.positions.size() - 1)});
  BuildReport exact, found;
  (void)build_mesh(crowd, &exact);
  (void)build_mesh(crowd, &found, rounding_gap);
  EXPECT_LE(found.boundary_edges, exact.boundary_edges);
  EXPECT_EQ(found.non_manifold_edges + found.misoriented_edges + found.pinched_vertices,
            exact.non_manifold_edges + exact.misoriented_edges + exact.pinched_vertices);
}

}  // namespace
}  // namespace papilio
