#include "papilio/mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "core/mesh/connect.h"
#include "papilio/error.h"
#include "tests/support/invariants.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

Fault fault_of(const TriangleMesh& mesh) {
  try {
    (void)build_mesh(mesh);
  } catch (const Error& error) {
    EXPECT_GT(std::string(error.what()).size(), 20U);
    return error.fault();
  }
  ADD_FAILURE() << "was not refused";
  return Fault::cancelled;
}

TEST(Mesh, ClosedShapesHaveTheirEulerCharacteristic) {
  EXPECT_EQ(build_mesh(tetrahedron()).topology.euler_characteristic(), 2);
  EXPECT_EQ(build_mesh(icosahedron()).topology.euler_characteristic(), 2);
  EXPECT_EQ(build_mesh(cube()).topology.euler_characteristic(), 2);
  EXPECT_EQ(build_mesh(torus(5, 4)).topology.euler_characteristic(), 0);
  EXPECT_EQ(build_mesh(grid(3, 2)).topology.euler_characteristic(), 1);
  EXPECT_EQ(build_mesh(join(torus(3, 3), icosahedron(), 9)).topology.euler_characteristic(), 2);
}

TEST(Mesh, RandomManifoldsAreConsistentAndCleanlyReported) {
  for (uint32_t seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    const TriangleMesh input = random_manifold(random);
    BuildReport report;
    const Mesh mesh = build_mesh(input, &report);
    ASSERT_TRUE(is_consistent(mesh)) << "seed " << seed;
    ASSERT_EQ(mesh.topology.face_count(), input.triangles.size());
    ASSERT_EQ(report.boundary_edges, count_edges(input).boundary);
    ASSERT_EQ(report.non_manifold_edges + report.misoriented_edges, 0U);
  }
}

TEST(Mesh, PointsOfEqualPositionAreWelded) {
  TriangleMesh soup;
  for (const Triangle& t : cube().triangles) {
    for (uint32_t v : t) soup.positions.push_back(cube().positions[v]);
    const auto n = static_cast<uint32_t>(soup.positions.size());
    soup.triangles.push_back({n - 3, n - 2, n - 1});
  }
  soup.positions[0].x = -0.0F;  // equal to 0
  BuildReport report;
  const Mesh mesh = build_mesh(soup, &report);
  EXPECT_EQ(mesh.topology.vertex_count, 8U);
  EXPECT_EQ(report.welded_points, 28U);
  EXPECT_EQ(report.boundary_edges, 0U);
  EXPECT_TRUE(is_consistent(mesh));
}

TEST(Mesh, VerticesAreNumberedInOrderOfTheFaces) {
  const Mesh mesh = build_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{3, 2, 1}, {0, 1, 2}}});
  EXPECT_EQ(mesh.topology.origin, (Buffer<uint32_t>{0, 1, 2, 3, 2, 1}));
  EXPECT_EQ(mesh.positions[0], (Vec3f{1, 1, 0}));
}

TEST(Mesh, DefectiveFacesAndPointsAreDroppedAndCounted) {
  TriangleMesh mesh = tetrahedron();
  mesh.positions.push_back({9, 9, 9});          // isolated
  mesh.triangles.push_back({0, 1, 1});          // degenerate
  mesh.triangles.push_back({2, 1, 0});          // repeated: the first face, reversed
  mesh.positions.push_back(mesh.positions[0]);  // welded
  mesh.triangles.push_back({0, 5, 2});          // degenerate once welded
  BuildReport report;
  const Mesh built = build_mesh(mesh, &report);
  EXPECT_EQ(built.topology.face_count(), 4U);
  EXPECT_EQ(report.isolated_points, 1U);
  EXPECT_EQ(report.degenerate_faces, 2U);
  EXPECT_EQ(report.repeated_faces, 1U);
  EXPECT_EQ(report.welded_points, 1U);
  EXPECT_TRUE(is_consistent(built));
}

TEST(Mesh, TwoFacesBackToBackAreASphere) {
  BuildReport report;
  const Mesh mesh = build_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}}, &report);
  EXPECT_EQ(report.repeated_faces, 0U);
  EXPECT_EQ(mesh.topology.euler_characteristic(), 2);
  EXPECT_TRUE(is_consistent(mesh));
}

TEST(Mesh, NonManifoldAndMisorientedEdgesAreShared) {
  BuildReport report;
  const Mesh book = build_mesh(
      {{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}}}, &report);
  EXPECT_EQ(report.non_manifold_edges, 1U);
  EXPECT_TRUE(is_consistent(book));
  const Mesh twisted = build_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 2, 3}}}, &report);
  EXPECT_EQ(report.misoriented_edges, 1U);
  EXPECT_EQ(report.boundary_edges, 4U);
  EXPECT_TRUE(is_consistent(twisted));
}

TEST(Mesh, PinchedVerticesAreFound) {
  BuildReport report;
  (void)build_mesh(join(tetrahedron(), tetrahedron(), 9), &report);
  EXPECT_EQ(report.pinched_vertices, 0U);
  TriangleMesh touching = join(tetrahedron(), tetrahedron(), 9);
  touching.positions[5] = touching.positions[0];
  const Mesh mesh = build_mesh(touching, &report);
  EXPECT_EQ(report.pinched_vertices, 1U);
  EXPECT_EQ(mesh.positions[mesh.topology.pinched.at(0)], touching.positions[0]);
  (void)build_mesh(fan(5, false), &report);
  EXPECT_EQ(report.pinched_vertices, 0U);
}

TEST(Mesh, UnusableInputsAreRefused) {
  EXPECT_EQ(fault_of({}), Fault::no_faces);
  EXPECT_EQ(fault_of({{{0, 0, 0}}, {{0, 0, 0}}}), Fault::no_faces);
  EXPECT_EQ(fault_of({{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}}), Fault::index_out_of_range);
  for (float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -2e18F}) {
    TriangleMesh mesh = cube();
    mesh.positions[3].y = bad;
    EXPECT_EQ(fault_of(mesh), Fault::not_finite);
  }
}

TEST(Mesh, VerticesOfValence100000AreBuilt) {
  const Mesh mesh = build_mesh(bipyramid(100'000));
  EXPECT_EQ(mesh.topology.euler_characteristic(), 2);
}

TEST(Mesh, BoxOfACubeIsTheCube) {
  const Box box = bounding_box(cube().positions);
  EXPECT_EQ(box.min, (Vec3f{0, 0, 0}));
  EXPECT_EQ(box.max, (Vec3f{1, 1, 1}));
  EXPECT_DOUBLE_EQ(box.diagonal(), std::sqrt(3.0));
  EXPECT_EQ(bounding_box({}).diagonal(), 0);
  EXPECT_EQ(bounding_box({}).largest_coordinate(), 0);
}

TEST(Mesh, BoxBoundsAnyNumberOfPoints) {
  const std::vector<Vec3f> points{{1, -2, 3}, {-4, 5, -6}, {7, -8, 9}, {-7, 2, -10}};
  for (size_t count = 1; count <= points.size(); ++count)
    for (size_t first = 0; first + count <= points.size(); ++first) {
      const std::vector<Vec3f> some(points.begin() + static_cast<ptrdiff_t>(first),
                                    points.begin() + static_cast<ptrdiff_t>(first + count));  // no readable padding
      const auto least = [&](float Vec3f::*c) { return (*std::ranges::min_element(some, {}, c)).*c; };
      const auto most = [&](float Vec3f::*c) { return (*std::ranges::max_element(some, {}, c)).*c; };
      const Box box = bounding_box(some);
      EXPECT_EQ(box.min, (Vec3f{least(&Vec3f::x), least(&Vec3f::y), least(&Vec3f::z)}));
      EXPECT_EQ(box.max, (Vec3f{most(&Vec3f::x), most(&Vec3f::y), most(&Vec3f::z)}));
    }
  EXPECT_EQ(bounding_box(points).largest_coordinate(), 10);
  EXPECT_EQ(bounding_box(std::span(points).first(1)).largest_coordinate(), 3);
}

/// Twelve faces between eight points: edges of three faces, pinched vertices, faces wound against each other.
TriangleMesh random_soup(std::mt19937& random) {
  TriangleMesh mesh;
  for (uint32_t p = 0; p < 8; ++p) mesh.positions.push_back({float(p & 1U), float(p >> 1U & 1U), float(p >> 2U)});
  for (int f = 0; f < 12; ++f) {
    const auto corner = [&] { return static_cast<uint32_t>(random() % 8); };
    mesh.triangles.push_back({corner(), corner(), corner()});
  }
  return mesh;
}

TEST(NumberEdges, NumberedEdgesEqualTheBuiltOnes) {
  std::mt19937 random(11);
  for (int i = 0; i < 300; ++i) {
    const Topology built = build_mesh(i % 2 == 0 ? random_soup(random) : random_manifold(random)).topology;
    Topology mesh = built;
    forget_edges(mesh);
    EXPECT_FALSE(mesh.has_edges());
    mesh.darts = {0};  // of a crease that is lost
    number_edges(mesh);
    ASSERT_TRUE(mesh.darts.empty());
    ASSERT_TRUE(mesh.has_edges());
    ASSERT_EQ(mesh.edge, built.edge);
    ASSERT_EQ(mesh.half_edge, built.half_edge);
    ASSERT_EQ(mesh.kind, built.kind);
  }
}

// Edges are found by another algorithm above a certain valence.
TEST(Mesh, HubsOfAnyValenceAreConnected) {
  for (uint32_t valence : {5U, 30U, 31U, 32U, 33U, 34U, 35U, 3000U})
    for (bool closed : {false, true}) {
      BuildReport report;
      const Mesh mesh = build_mesh(fan(valence, closed), &report);
      EXPECT_TRUE(is_consistent(mesh));
      EXPECT_EQ(report.boundary_edges, closed ? valence : valence + 2);
      EXPECT_EQ(mesh.topology.edge_count(), closed ? 2 * valence : 2 * valence + 1);
      EXPECT_EQ(mesh.topology.euler_characteristic(), 1);
      for (uint32_t e = 1; e < mesh.topology.edge_count(); ++e)
        ASSERT_LT(mesh.topology.half_edge[e - 1], mesh.topology.half_edge[e]);
    }
}

TEST(Mesh, TrianglesOfAnRvalueMeshAreEqual) {
  TriangleMesh with_attributes = cube();
  with_attributes.attributes = {
      {.components = 1, .values = std::vector<double>(with_attributes.positions.size(), 0.5)}};
  for (const TriangleMesh& triangles : {torus(5, 4), with_attributes}) {
    Mesh mesh = build_mesh(triangles);
    const TriangleMesh expected = mesh.triangles();
    EXPECT_EQ(expected.triangles.size(), triangles.triangles.size());
    EXPECT_EQ(std::move(mesh).triangles(), expected);
  }
}

}  // namespace
}  // namespace papilio
