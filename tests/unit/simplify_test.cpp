#include "core/simplify/simplify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "core/criteria/camera.h"
#include "core/mesh/normals.h"
#include "tests/support/invariants.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"
#include "tests/support/simplified.h"

namespace papilio {
namespace {

using namespace test;

class SimplifyRealMesh : public ::testing::TestWithParam<const char*> {};

TEST_P(SimplifyRealMesh, VisibleFacesAndTopologyAreKept) {
  const Mesh mesh = build_mesh(real_mesh(GetParam()));
  for (const View& view : views_of(mesh)) {
    const Mesh result = simplify_checked(mesh, view);
    EXPECT_LT(share_left(mesh, view, result), mesh.topology.face_count() > 10000 ? 0.5 : 0.8);
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, SimplifyRealMesh,
                         ::testing::Values("cgal/camel.off", "cgal/armadillo.off", "cgal/rotor_small.off",  // a torus
                                           "cgal/bones.off",          // 26 components
                                           "cgal/lion-head.off",      // open
                                           "cgal/diplodocus.off",     // not manifold
                                           "cgal/fandisk_large.off",  // sharp
                                           "bunny.obj"));

TEST(SimplifyHidden, FullyVisibleMeshIsUnchanged) {
  const Mesh mesh = build_mesh(grid(10, 10));
  const View view = looking_at(mesh, {0, 0, 1}, 2);
  ASSERT_EQ(count_true(hidden_from(mesh, view)), 0U);
  const Mesh result = simplify_hidden(mesh, Camera(view));
  EXPECT_EQ(result.topology.origin, mesh.topology.origin);
  EXPECT_EQ(result.topology.kind, mesh.topology.kind);
  EXPECT_EQ(result.positions, mesh.positions);
}

TEST(SimplifyHidden, FullyHiddenMeshIsSimplified) {
  for (const TriangleMesh& shape :
       {torus(60, 30), grid(40, 40), join(torus(40, 20), torus(50, 20), 5), icosahedron()}) {
    const Mesh mesh = build_mesh(shape);
    const View view = looking_elsewhere(mesh);
    ASSERT_EQ(count_true(hidden_from(mesh, view)), mesh.topology.face_count());
    const Mesh result = simplify_checked(mesh, view);
    EXPECT_LT(share_left(mesh, view, result), mesh.topology.face_count() > 20 ? 0.5 : 1.1);
  }
}

// meshoptimizer removes small components and reduces others to two faces back to back.
TEST(SimplifyHidden, NoComponentIsLostAtAnyError) {
  const Mesh bones = build_mesh(real_mesh("cgal/bones.off"));
  const Mesh small = build_mesh(join(join(tetrahedron(), octahedron(), 100), icosahedron(), 200));
  for (const Mesh* mesh : {&bones, &small})
    for (double error : {0.0, 0.02, 0.1, 1.0}) simplify_checked(*mesh, looking_elsewhere(*mesh), error);
}

TEST(SimplifyHidden, FlatSheetIsSimplifiedAtZeroError) {
  const Mesh mesh = build_mesh(grid(30, 30));
  const Mesh result = simplify_checked(mesh, looking_elsewhere(mesh), 0);
  EXPECT_LT(result.topology.face_count(), 200U);  // 118 between the boundary's 120 vertices
}

TEST(SimplifyHidden, TiltedFlatSheetIsHalved) {
  TriangleMesh shape = grid(30, 30);
  for (Vec3f& p : shape.positions) p = {0.1F * p.x + 0.03F * p.y, 0.1F * p.y - 0.07F * p.x, 0.01F * p.x + 0.05F * p.y};
  const Mesh mesh = build_mesh(shape);
  const Mesh result = simplify_checked(mesh, looking_elsewhere(mesh));
  EXPECT_LT(share_left(mesh, looking_elsewhere(mesh), result), 0.5);
}

TEST(SimplifyHidden, SheetsAtANonManifoldLineAreHalved) {
  TriangleMesh sheets = grid(20, 20);
  const TriangleMesh flat = sheets;
  const auto offset = static_cast<uint32_t>(flat.positions.size());
  for (const Vec3f& p : flat.positions) sheets.positions.push_back({p.x, 10, p.y});
  for (const Triangle& t : flat.triangles) sheets.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  BuildReport report;
  const Mesh mesh = build_mesh(sheets, &report);
  ASSERT_EQ(report.non_manifold_edges, 20U);
  EXPECT_LT(share_left(mesh, looking_elsewhere(mesh), simplify_checked(mesh, looking_elsewhere(mesh))), 0.5);
  for (const View& view : views_of(mesh)) simplify_checked(mesh, view);
}

TEST(SimplifyHidden, PinchedVertexIsKept) {
  TriangleMesh shape = fan(12, true);  // two cones, apex to apex
  for (size_t p = 1; p < shape.positions.size(); ++p) shape.positions[p].z = 1;
  const auto ring = static_cast<uint32_t>(shape.positions.size() - 1);
  for (uint32_t p = 1; p <= ring; ++p) {
    const Vec3f above = shape.positions[p];
    shape.positions.push_back({above.x, above.y, -1});
  }
  const Buffer<Triangle> upper = shape.triangles;
  const auto below = [&](uint32_t p) { return p == 0 ? 0 : p + ring; };
  for (const Triangle& t : upper) shape.triangles.push_back({below(t[0]), below(t[2]), below(t[1])});
  const Mesh mesh = build_mesh(shape);
  ASSERT_EQ(mesh.topology.pinched.size(), 1U);
  simplify_checked(mesh, looking_elsewhere(mesh), 1);
}

TEST(SimplifyHidden, CreasesAndDartsAreKept) {
  Mesh mesh = build_mesh(torus(60, 30));
  std::map<uint32_t, int> ends;
  for (uint32_t e = 0; e < mesh.topology.edge_count(); e += 37) {
    mesh.topology.kind[e] = EdgeKind::crease;
    ++ends[mesh.topology.origin[mesh.topology.half_edge[e]]];
    ++ends[mesh.topology.tip(mesh.topology.half_edge[e])];
  }
  for (const auto& [v, creases_there] : ends)
    if (creases_there == 1) mesh.topology.darts.push_back(v);
  for (const View& view : views_of(mesh)) simplify_checked(mesh, view);
  const Mesh result = simplify_checked(mesh, looking_elsewhere(mesh));
  EXPECT_LT(result.topology.face_count(), mesh.topology.face_count() * 3 / 4);
}

TEST(SimplifyHidden, ResultDoesNotDependOnScale) {
  const Mesh unit = build_mesh(torus(60, 30));
  const Mesh expected = simplify_checked(unit, looking_at(unit, {0, 0.3, 1}, 1));
  for (float scale : {0x1p58F, 0x1p-100F}) {
    Mesh mesh = unit;
    for (Vec3f& p : mesh.positions) p = scale * p;
    const Mesh result = simplify_hidden(mesh, Camera(looking_at(mesh, {0, 0.3, 1}, 1)));
    EXPECT_EQ(result.topology.origin, expected.topology.origin) << scale;
  }
}

// 80,000 faces are split into two parts.
TEST(SimplifyHidden, MeshOfSeveralPartsKeepsItsTopology) {
  const Mesh mesh = build_mesh(grid(200, 200));
  const View view = looking_elsewhere(mesh);
  const Mesh result = simplify_hidden(mesh, Camera(view));
  EXPECT_TRUE(is_consistent({result.topology, result.positions}));
  EXPECT_EQ(open_half_edges(result), open_half_edges(mesh));
  EXPECT_EQ(result.topology.euler_characteristic(), mesh.topology.euler_characteristic());
  EXPECT_LT(share_left(mesh, view, result), 0.1);
}

TEST(SimplifyHidden, FacesAtACrowdedVertexAreKept) {
  TriangleMesh cone = fan(300, true);
  cone.positions[0].z = 0.5F;
  const Mesh mesh = build_mesh(join(cone, grid(20, 20), 3));
  const Mesh result = simplify_checked(mesh, looking_elsewhere(mesh));
  std::vector<uint32_t> faces(result.topology.vertex_count, 0);
  for (uint32_t v : result.topology.origin) ++faces[v];
  EXPECT_EQ(std::ranges::count(faces, 300U), 1);
  EXPECT_LT(result.topology.face_count(), 500U);
}

TEST(SimplifyHidden, ThrowingPollStopsAtAnyCall) {
  const Mesh mesh = build_mesh(grid(200, 200));
  const Camera camera(looking_elsewhere(mesh));
  int calls = 0;
  (void)simplify_hidden(mesh, camera, default_hidden_error, [&] { ++calls; });
  EXPECT_GT(calls, 6);
  for (int last = 1; last <= calls; last += 4) {
    int left = last;
    EXPECT_THROW((void)simplify_hidden(mesh, camera, default_hidden_error,
                                       [&] {
                                         if (--left == 0) throw std::runtime_error("stopped");
                                       }),
                 std::runtime_error);
    EXPECT_EQ(left, 0);
  }
}

TEST(SimplifyHidden, RandomMeshesStayConsistent) {
  std::mt19937 random(7);
  for (int i = 0; i < 40; ++i) {
    const Mesh mesh = build_mesh(random_manifold(random));
    for (const View& view : views_of(mesh)) simplify_checked(mesh, view, 0.02);
  }
}

TEST(HiddenFaces, BackFacesAndFacesOutsideAreHidden) {
  const Mesh mesh = build_mesh(cube());
  View view = looking_at(mesh, {0, 0, 1}, 4);
  const std::vector<bool> hidden = hidden_from(mesh, view);
  EXPECT_EQ(count_true(hidden), 10U);
  const Buffer<Vec3f> normals = face_normals(mesh);
  for (uint32_t f = 0; f < hidden.size(); ++f) EXPECT_EQ(hidden[f], normals[f].z < 0.5F);
  const Mesh flat = build_mesh({{{0, 0, 0}, {2, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}});
  EXPECT_EQ(count_true(hidden_from(flat, looking_at(flat, {0, 0, 1}, 2))), 0U);  // no normal: never back-facing
  EXPECT_EQ(count_true(hidden_from(flat, looking_elsewhere(flat))), 1U);
}

}  // namespace
}  // namespace papilio
