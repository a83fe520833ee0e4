#include "core/simplify/simplify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/criteria/camera.h"
#include "core/criteria/view_culling.h"
#include "core/mesh/normals.h"
#include "tests/support/invariants.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

using Place = std::array<float, 3>;
Place place(Vec3f p) { return {p.x, p.y, p.z}; }

std::vector<bool> hidden_from(const Mesh& mesh, const View& view) {
  return hidden_faces(mesh, face_normals(mesh), Camera(view));
}

size_t count(const std::vector<bool>& flags) { return static_cast<size_t>(std::ranges::count(flags, true)); }

View looking_at(const Mesh& mesh, Vec3d direction, double distance) {
  const Box box = bounding_box(mesh.positions);
  View view;
  view.target = 0.5 * (to_double(box.min) + to_double(box.max));
  view.eye = view.target + (distance * box.diagonal()) * direction;
  return view;
}

/// View with the mesh behind the eye.
View looking_elsewhere(const Mesh& mesh) {
  View view = looking_at(mesh, {0, 0, 1}, 2);
  view.target = view.eye + Vec3d{0, 0, 1};
  return view;
}

View orthographic(View view) {
  view.projection = Projection::orthographic;
  return view;
}

/// Views of the whole mesh, of its front in parallel projection, and of a small part from nearby.
std::vector<View> views_of(const Mesh& mesh) {
  return {looking_at(mesh, {0.6, 0.4, 1}, 1), orthographic(looking_at(mesh, {-1, 0.3, 0.2}, 1)),
          looking_at(mesh, {0.1, 0.2, 0.9}, 0.25)};
}

/// Returns the boundary half-edges by the positions of their ends.
std::multiset<std::array<Place, 2>> open_half_edges(const Mesh& mesh) {
  std::multiset<std::array<Place, 2>> open;
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
    if (mesh.topology.twin[h] == none)
      open.insert({place(mesh.positions[mesh.topology.origin[h]]), place(mesh.positions[mesh.topology.tip(h)])});
  return open;
}

std::set<Place> places(const Mesh& mesh, const std::vector<uint32_t>& vertices) {
  std::set<Place> found;
  for (uint32_t v : vertices) found.insert(place(mesh.positions[v]));
  return found;
}

std::set<std::array<Place, 2>> creases(const Mesh& mesh) {
  std::set<std::array<Place, 2>> found;
  for (uint32_t e = 0; e < mesh.topology.edge_count(); ++e) {
    const uint32_t h = mesh.topology.half_edge[e];
    const Place a = place(mesh.positions[mesh.topology.origin[h]]);
    const Place b = place(mesh.positions[mesh.topology.tip(h)]);
    if (mesh.topology.kind[e] == EdgeKind::crease) found.insert({std::min(a, b), std::max(a, b)});
  }
  return found;
}

size_t faces_without_normal(const Mesh& mesh) {
  return static_cast<size_t>(std::ranges::count_if(face_normals(mesh), [](Vec3f n) { return !has_normal(n); }));
}

/// Returns the number of faces whose normal opposes the original surface's at each of their corners.
size_t flipped_faces(const Mesh& before, const Mesh& after) {
  std::map<Place, Vec3f> surface;
  const Buffer<Vec3f> vertex = vertex_normals(before);
  for (size_t v = 0; v < vertex.size(); ++v) surface[place(before.positions[v])] = vertex[v];
  const Buffer<Vec3f> normals = face_normals(after);
  size_t flipped = 0;
  for (uint32_t f = 0; f < normals.size(); ++f) {
    bool against = true;
    for (uint32_t i = 0; i < 3; ++i)
      against &= dot(normals[f], surface.at(place(after.positions[after.topology.origin[3 * f + i]]))) < 0;
    flipped += against ? 1 : 0;
  }
  return flipped;
}

/// Positions and attribute values at the corners of a visible face.
void expect_visible_faces_kept(const Mesh& before, const std::vector<bool>& hidden, const Mesh& after) {
  uint32_t g = 0;  // the face of the result
  size_t differing = 0;
  for (uint32_t f = 0; f < before.topology.face_count(); ++f) {
    if (hidden[f]) continue;
    ASSERT_LT(g, after.topology.face_count());
    for (uint32_t i = 0; i < 3; ++i) {
      const uint32_t a = 3 * f + i;
      const uint32_t b = 3 * g + i;
      differing += before.positions[before.topology.origin[a]] != after.positions[after.topology.origin[b]] ? 1 : 0;
      for (size_t k = 0; k < before.attributes.attributes.size(); ++k) {
        const Attribute& was = before.attributes.attributes[k];
        const Attribute& is = after.attributes.attributes[k];
        for (size_t c = 0; c < was.components; ++c)
          differing += was.values[was.components * before.attributes.point[a] + c] !=
                               is.values[was.components * after.attributes.point[b] + c]
                           ? 1
                           : 0;
      }
    }
    ++g;
  }
  EXPECT_EQ(differing, 0U);
}

/// Simplifies and checks all invariants. Returns the result.
Mesh simplify_checked(const Mesh& mesh, const View& view, double error = default_hidden_error) {
  const Camera camera(view);
  Mesh result = simplify_hidden(mesh, camera, error);
  expect_visible_faces_kept(mesh, hidden_from(mesh, view), result);

  Mesh bare{result.topology, result.positions};
  EXPECT_TRUE(is_consistent(bare));
  EXPECT_EQ(result.topology.euler_characteristic(), mesh.topology.euler_characteristic());
  EXPECT_EQ(open_half_edges(result), open_half_edges(mesh));
  EXPECT_EQ(places(result, result.topology.pinched), places(mesh, mesh.topology.pinched));
  EXPECT_EQ(places(result, result.topology.darts), places(mesh, mesh.topology.darts));
  EXPECT_EQ(creases(result), creases(mesh));
  EXPECT_LE(faces_without_normal(result), faces_without_normal(mesh));
  EXPECT_LE(flipped_faces(mesh, result), flipped_faces(mesh, mesh));
  size_t next = 0;  // remaining vertices keep their order
  for (const Vec3f& p : mesh.positions)
    if (next < result.positions.size() && result.positions[next] == p) ++next;
  EXPECT_EQ(next, result.positions.size());

  const Mesh again = simplify_hidden(mesh, camera, error);
  EXPECT_EQ(again.topology.origin, result.topology.origin);
  EXPECT_EQ(again.positions, result.positions);
  return result;
}

/// Returns the remaining share of the hidden faces.
double share_left(const Mesh& before, const View& view, const Mesh& after) {
  const auto hidden = static_cast<double>(count(hidden_from(before, view)));
  return 1 - (before.topology.face_count() - after.topology.face_count()) / hidden;
}

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
  ASSERT_EQ(count(hidden_from(mesh, view)), 0U);
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
    ASSERT_EQ(count(hidden_from(mesh, view)), mesh.topology.face_count());
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

/// Returns a mesh with a chart per value of `chart_of(centroid)`; attributes are the position and the chart.
template <class ChartOf>
Mesh charted(const TriangleMesh& shape, const ChartOf& chart_of) {
  Mesh mesh = build_mesh(shape);
  Attribute position{3, false, {}};
  Attribute chart{1, false, {}};
  std::map<std::pair<uint32_t, int>, uint32_t> points;
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
    const auto corner = [&](uint32_t i) { return mesh.positions[mesh.topology.origin[h - h % 3 + i]]; };
    const int c = chart_of((1.0F / 3) * (corner(0) + corner(1) + corner(2)));
    const auto number = static_cast<uint32_t>(points.size());
    const auto [at, is_new] = points.try_emplace({mesh.topology.origin[h], c}, number);
    if (is_new) {
      const Vec3f p = mesh.positions[mesh.topology.origin[h]];
      position.values.insert(position.values.end(), {p.x, p.y, p.z});
      chart.values.push_back(c);
    }
    mesh.attributes.point.push_back(at->second);
  }
  mesh.attributes.point_count = static_cast<uint32_t>(points.size());
  mesh.attributes.attributes = {position, chart};
  return mesh;
}

void expect_charts_whole(const Mesh& mesh) {
  const PointAttributes& attributes = mesh.attributes;
  ASSERT_EQ(attributes.point.size(), mesh.topology.half_edge_count());
  ASSERT_EQ(attributes.attributes.size(), 2U);
  ASSERT_EQ(attributes.attributes[0].values.size(), size_t{3} * attributes.point_count);
  ASSERT_EQ(attributes.attributes[1].values.size(), attributes.point_count);
  const std::set<uint32_t> used(attributes.point.begin(), attributes.point.end());
  EXPECT_EQ(used.size(), attributes.point_count);
  EXPECT_LT(*used.rbegin(), attributes.point_count);
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
    const uint32_t p = attributes.point[h];
    const double* values = &attributes.attributes[0].values[size_t{3} * p];
    ASSERT_EQ(to_double(mesh.positions[mesh.topology.origin[h]]), (Vec3d{values[0], values[1], values[2]}));
    ASSERT_EQ(attributes.attributes[1].values[p],
              attributes.attributes[1].values[attributes.point[Topology::next(h)]]);  // a face is in one chart
  }
}

/// Returns the edges between two charts by the positions of their ends.
std::set<std::array<Place, 2>> seams(const Mesh& mesh) {
  std::set<std::array<Place, 2>> found;
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
    const uint32_t t = mesh.topology.twin[h];
    if (t != none && mesh.attributes.point[h] != mesh.attributes.point[Topology::next(t)])
      found.insert({place(mesh.positions[mesh.topology.origin[h]]), place(mesh.positions[mesh.topology.tip(h)])});
  }
  return found;
}

TEST(SimplifyHidden, ChartsKeepTheirAttributes) {
  const auto halves = [](Vec3f p) { return p.x < 0.1F ? 1 : 2; };
  const auto patches = [](Vec3f p) {
    return static_cast<int>(10 + std::floor(4 * p.x) + 20 * std::floor(4 * p.y) + 400 * std::floor(4 * p.z));
  };
  for (const Mesh& mesh : {charted(torus(80, 40), halves), charted(torus(80, 40), patches),
                           charted(real_mesh("cgal/lion-head.off"), patches)}) {
    expect_charts_whole(mesh);
    std::vector<View> views = views_of(mesh);
    views.push_back(looking_elsewhere(mesh));
    for (const View& view : views) {
      const Mesh result = simplify_checked(mesh, view);
      expect_charts_whole(result);
      EXPECT_EQ(seams(result), seams(mesh));
      EXPECT_LT(share_left(mesh, view, result), 0.8);
    }
  }
}

// At the end of the seam, an edge has two points at one of its vertices.
TEST(SimplifyHidden, SeamThatEndsInsideIsKept) {
  Mesh mesh = charted(grid(20, 20), [](Vec3f) { return 0; });
  const Topology& topology = mesh.topology;
  for (uint32_t h = 0; h < topology.half_edge_count(); ++h) {
    const Vec3f p = mesh.positions[topology.origin[h]];
    const Vec3f middle = 0.5F * (mesh.positions[topology.tip(h)] + mesh.positions[topology.apex(h)]);
    if (p.x != 10 || p.y < 5 || p.y > 15 || middle.x < 10) continue;  // the right side of a slit
    mesh.attributes.point[h] = mesh.attributes.point_count + static_cast<uint32_t>(p.y) - 5;
  }
  for (int y = 5; y <= 15; ++y) {
    mesh.attributes.attributes[0].values.insert(mesh.attributes.attributes[0].values.end(), {10, double(y), 0});
    mesh.attributes.attributes[1].values.push_back(0);
  }
  mesh.attributes.point_count += 11;
  expect_charts_whole(mesh);
  const Mesh result = simplify_checked(mesh, looking_elsewhere(mesh));
  expect_charts_whole(result);
  EXPECT_EQ(seams(result), seams(mesh));
  EXPECT_LT(share_left(mesh, looking_elsewhere(mesh), result), 0.5);
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
  EXPECT_EQ(count(hidden), 10U);
  const Buffer<Vec3f> normals = face_normals(mesh);
  for (uint32_t f = 0; f < hidden.size(); ++f) EXPECT_EQ(hidden[f], normals[f].z < 0.5F);
  const Mesh flat = build_mesh({{{0, 0, 0}, {2, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}});
  EXPECT_EQ(count(hidden_from(flat, looking_at(flat, {0, 0, 1}, 2))), 0U);  // no normal: never back-facing
  EXPECT_EQ(count(hidden_from(flat, looking_elsewhere(flat))), 1U);
}

}  // namespace
}  // namespace papilio
