#include "tests/support/simplified.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "core/criteria/camera.h"
#include "core/criteria/view_culling.h"
#include "core/mesh/normals.h"
#include "core/simplify/simplify.h"
#include "tests/support/invariants.h"

namespace papilio::test {
namespace {

View orthographic(View view) {
  view.projection = Projection::orthographic;
  return view;
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

}  // namespace

Place place(Vec3f p) { return {p.x, p.y, p.z}; }

std::vector<bool> hidden_from(const Mesh& mesh, const View& view) {
  return hidden_faces(mesh, face_normals(mesh), Camera(view));
}

size_t count_true(const std::vector<bool>& flags) { return static_cast<size_t>(std::ranges::count(flags, true)); }

View looking_at(const Mesh& mesh, Vec3d direction, double distance) {
  const Box box = bounding_box(mesh.positions);
  View view;
  view.target = 0.5 * (to_double(box.min) + to_double(box.max));
  view.eye = view.target + (distance * box.diagonal()) * direction;
  return view;
}

View looking_elsewhere(const Mesh& mesh) {
  View view = looking_at(mesh, {0, 0, 1}, 2);
  view.target = view.eye + Vec3d{0, 0, 1};
  return view;
}

std::vector<View> views_of(const Mesh& mesh) {
  return {looking_at(mesh, {0.6, 0.4, 1}, 1), orthographic(looking_at(mesh, {-1, 0.3, 0.2}, 1)),
          looking_at(mesh, {0.1, 0.2, 0.9}, 0.25)};
}

std::multiset<std::array<Place, 2>> open_half_edges(const Mesh& mesh) {
  std::multiset<std::array<Place, 2>> open;
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
    if (mesh.topology.twin[h] == none)
      open.insert({place(mesh.positions[mesh.topology.origin[h]]), place(mesh.positions[mesh.topology.tip(h)])});
  return open;
}

Mesh simplify_checked(const Mesh& mesh, const View& view, double error) {
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

double share_left(const Mesh& before, const View& view, const Mesh& after) {
  const auto hidden = static_cast<double>(count_true(hidden_from(before, view)));
  return 1 - (before.topology.face_count() - after.topology.face_count()) / hidden;
}

}  // namespace papilio::test
