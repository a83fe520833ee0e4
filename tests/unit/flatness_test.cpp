#include "core/criteria/flatness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/mesh/normals.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

uint32_t count(const Marks& marks) {
  return static_cast<uint32_t>(std::count_if(marks.begin(), marks.end(), [](uint8_t m) { return m != 0; }));
}

Marks flatness_marks(const Mesh& mesh, double threshold) {
  return find_curved(mesh, face_normals(mesh), threshold, Growth::off, whole_region(mesh.topology));
}

void grow(const Topology& mesh, Growth growth, Marks& marks) { papilio::grow(mesh, growth, whole_region(mesh), marks); }

TEST(Flatness, CubeMarksItsTwelveEdgesAndNoDiagonal) {
  const Mesh mesh = build_mesh(cube());
  EXPECT_EQ(count(flatness_marks(mesh, 0.5)), 12U);  // right angles: 0 < 0.5
  EXPECT_EQ(count(flatness_marks(mesh, 0.0)), 0U);   // 0 is not below 0: flat is tau >= t
  EXPECT_EQ(count(flatness_marks(mesh, 1.0)), 12U);  // the diagonals have exactly 1
  EXPECT_EQ(count(flatness_marks(mesh, -1.0)), 0U);
}

TEST(Flatness, AllEdgesOfAnIcosahedronHaveOneThreshold) {
  const Mesh mesh = build_mesh(icosahedron());
  const double tau = std::sqrt(5.0) / 3;
  EXPECT_EQ(count(flatness_marks(mesh, tau + 1e-5)), 30U);
  EXPECT_EQ(count(flatness_marks(mesh, tau - 1e-5)), 0U);
}

TEST(Flatness, BoundaryEdgesAreMarkedWhereTheirCurveTurns) {
  const Mesh mesh = build_mesh(grid(4, 4));
  // Flat inside; the boundary turns by 90 degrees at four corners of two boundary edges each.
  EXPECT_EQ(count(flatness_marks(mesh, 0.5)), 8U);
  EXPECT_EQ(count(flatness_marks(mesh, -0.1)), 0U);
}

TEST(Flatness, FaceWithoutAreaMarksNoEdges) {
  // A sliver whose three vertices lie on one line, between two faces of a folded sheet.
  const Mesh mesh = build_mesh(
      {{{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, -1, 0}, {1, 0, 1}}, {{0, 1, 2}, {1, 0, 3}, {0, 2, 4}, {2, 1, 4}}});
  const Marks marks = flatness_marks(mesh, 1.0);
  for (uint32_t i = 0; i < 3; ++i) EXPECT_EQ(marks[mesh.topology.edge[i]], 0);
}

TEST(Flatness, TiltedPlaneIsFlatAtThresholdOne) {
  TriangleMesh plane = grid(6, 6);
  for (Vec3f& p : plane.positions) p = {p.x + 0.3F * p.y, p.y - 0.7F * p.x, 0.37F * p.x + 0.51F * p.y};
  const Mesh mesh = build_mesh(plane);
  const Marks marks = flatness_marks(mesh, 1.0);
  for (uint32_t e = 0; e < mesh.topology.edge_count(); ++e) {
    if (mesh.topology.kind[e] == EdgeKind::smooth) {
      EXPECT_EQ(marks[e], 0);
    }
  }
}

TEST(Flatness, MarksDoNotDependOnScale) {
  for (float scale : {1e-30F, 1e17F}) {
    TriangleMesh shape = icosahedron();
    for (Vec3f& p : shape.positions) p = scale * p;
    EXPECT_EQ(count(flatness_marks(build_mesh(shape), 0.8)), 30U) << scale;
  }
}

TEST(Flatness, CutEdgesAreNeverMarked) {
  Mesh mesh = build_mesh(grid(20, 20));
  for (Vec3f& p : mesh.positions) p.z = std::sin(p.x) * std::cos(p.y);
  std::vector<uint32_t> cut;  // edges that end at the boundary
  for (uint32_t e = 0; e < mesh.topology.edge_count(); ++e) {
    const float y = mesh.positions[mesh.topology.origin[mesh.topology.half_edge[e]]].y;
    if (mesh.topology.kind[e] == EdgeKind::smooth && (y == 0 || y == 20)) cut.push_back(e);
  }
  ASSERT_FALSE(cut.empty());
  for (uint32_t e : cut) mesh.topology.kind[e] = EdgeKind::cut;
  const Marks marks = flatness_marks(mesh, 1.0);
  for (uint32_t e : cut) EXPECT_EQ(marks[e], 0) << e;
}

TEST(Growth, FacesModeMarksTheEdgesOfBothTriangles) {
  const Mesh mesh = build_mesh(icosahedron());
  Marks marks(30, 0);
  marks[7] = 1;
  grow(mesh.topology, Growth::off, marks);
  EXPECT_EQ(count(marks), 1U);
  grow(mesh.topology, Growth::faces, marks);
  EXPECT_EQ(count(marks), 5U);
}

TEST(Growth, VerticesModeMarksAllEdgesAtBothEnds) {
  const Mesh mesh = build_mesh(icosahedron());
  Marks marks(30, 0);
  marks[7] = 1;
  grow(mesh.topology, Growth::vertices, marks);
  EXPECT_EQ(count(marks), 9U);  // five at each end, one of them common
}

TEST(Growth, EachCallGrowsByOneStep) {
  const Mesh mesh = build_mesh(torus(12, 12));
  Marks marks(mesh.topology.edge_count(), 0);
  marks[0] = 1;
  Marks twice = marks;
  grow(mesh.topology, Growth::faces, marks);
  EXPECT_EQ(count(marks), 5U);
  grow(mesh.topology, Growth::faces, twice);
  grow(mesh.topology, Growth::faces, twice);
  EXPECT_GT(count(twice), count(marks));
}

}  // namespace
}  // namespace papilio
