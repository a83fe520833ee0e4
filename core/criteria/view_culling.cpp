#include "criteria/view_culling.h"

#include <cmath>

#include "mesh/four_children.h"
#include "mesh/normals.h"
#include "simd/extremes.h"

namespace papilio {
namespace {

enum : uint8_t { is_inside = 1, is_towards = 2, unknown = 2 };

}  // namespace

/// Visibility of faces in a view. Each face and each vertex is tested once.
class FaceVisibility {
 public:
  /// `normals` [F]; `longest` [V] edges.
  FaceVisibility(const Mesh& mesh, const Buffer<Vec3f>& normals, const Buffer<double>& longest, const Camera& camera)
      : mesh_(mesh),
        normals_(normals),
        longest_(longest),
        camera_(camera),
        of_face_(mesh.topology.face_count(), 0),
        inside_(mesh.topology.vertex_count, unknown) {}

  [[nodiscard]] const Topology& mesh() const { return mesh_.topology; }
  /// Returns `EdgesShown::is_known` and those of the bits `is_towards` and `is_inside` that hold for a face.
  [[nodiscard]] uint8_t of_face(FaceId f) {
    if (of_face_[f] == 0)
      of_face_[f] = EdgesShown::is_known | (is_away(f) ? 0 : is_towards) | (is_inside_somewhere(f) ? is_inside : 0);
    return of_face_[f];
  }
  [[nodiscard]] bool is_hidden(FaceId f) { return of_face(f) != EdgesShown::shown; }

 private:
  [[nodiscard]] Vec3d position(VertexId v) const { return to_double(mesh_.positions[v]); }
  [[nodiscard]] uint8_t is_vertex_inside(VertexId v) {
    if (inside_[v] == unknown) inside_[v] = camera_.is_outside(position(v), longest_[v]) ? 0 : 1;
    return inside_[v];
  }
  [[nodiscard]] bool is_inside_somewhere(FaceId f) {
    const uint32_t* corner = &mesh_.topology.origin[size_t{3} * f];
    return (is_vertex_inside(corner[0]) | is_vertex_inside(corner[1]) | is_vertex_inside(corner[2])) != 0;
  }
  [[nodiscard]] bool is_away(FaceId f) const {
    if (camera_.shows_backs()) return false;
    const uint32_t* corner = &mesh_.topology.origin[size_t{3} * f];
    const Vec3d centroid = (1.0 / 3) * (position(corner[0]) + position(corner[1]) + position(corner[2]));
    return has_normal(normals_[f]) && camera_.is_away(centroid, to_double(normals_[f]));
  }

  const Mesh& mesh_;
  const Buffer<Vec3f>& normals_;
  const Buffer<double>& longest_;
  const Camera& camera_;
  Buffer<uint8_t> of_face_;  ///< [F] bits; 0 if not tested
  Buffer<uint8_t> inside_;   ///< [V] 0, 1 or `unknown`
};

std::vector<bool> hidden_faces(const Mesh& mesh, const Buffer<Vec3f>& normals, const Camera& camera) {
  const Buffer<double> longest = longest_edges(mesh);
  FaceVisibility visibility(mesh, normals, longest, camera);
  std::vector<bool> hidden(mesh.topology.face_count());
  for (FaceId f = 0; f < hidden.size(); ++f) hidden[f] = visibility.is_hidden(f);
  return hidden;
}

Buffer<double> longest_edges(const Mesh& mesh) {
  const Topology& topology = mesh.topology;
  Buffer<double> longest(topology.vertex_count, 0);
  for (EdgeId e = 0; e < topology.edge_count(); ++e) {
    const uint32_t a = topology.origin[topology.half_edge[e]];
    const uint32_t b = topology.tip(topology.half_edge[e]);
    const Vec3d along = to_double(mesh.positions[b]) - to_double(mesh.positions[a]);
    const double squared = dot(along, along);
    longest[a] = larger(longest[a], squared);
    longest[b] = larger(longest[b], squared);
  }
  for (double& l : longest) l = std::sqrt(l);
  return longest;
}

Buffer<double> longest_edges_below(const Topology& parents, const Buffer<Vec3f>& positions) {
  Buffer<double> longest(positions.size(), 0);
  for (FaceId f = 0; f < parents.face_count(); ++f) {
    const uint32_t* corner = &parents.origin[size_t{3} * f];
    const uint32_t* edge = &parents.edge[size_t{3} * f];
    const uint32_t first_new = parents.vertex_count;
    const std::array<uint32_t, 6> vertex{corner[0],           corner[1],           corner[2],
                                         first_new + edge[0], first_new + edge[1], first_new + edge[2]};
    std::array<Vec3d, 6> p;
    for (uint32_t i = 0; i < 6; ++i) p[i] = to_double(positions[vertex[i]]);
    std::array<double, 6> squared{};
    visit_edges_of_four([&](uint32_t /*half_edge*/, uint32_t from, uint32_t to) {
      const Vec3d along = p[to] - p[from];
      const double squared_length = dot(along, along);
      squared[from] = larger(squared[from], squared_length);
      squared[to] = larger(squared[to], squared_length);
    });
    for (uint32_t i = 0; i < 6; ++i) longest[vertex[i]] = larger(longest[vertex[i]], squared[i]);
  }
  for (double& l : longest) l = std::sqrt(l);
  return longest;
}

EdgesShown::EdgesShown(const Mesh& mesh, const Buffer<Vec3f>& normals, const Buffer<double>& longest,
                       const Camera& camera, const Buffer<uint32_t>& shared)
    : faces_(std::make_shared<FaceVisibility>(mesh, normals, longest, camera)),
      of_edge_(mesh.topology.edge_count(), 0) {
  for (HalfEdgeId h : shared) of_edge_[mesh.topology.edge[h]] |= faces_->of_face(h.face());
}

uint8_t EdgesShown::find(EdgeId edge) const {
  const HalfEdgeId h = faces_->mesh().half_edge[edge];
  const HalfEdgeId t = faces_->mesh().twin[h];
  return of_edge_[edge] = faces_->of_face(h.face()) | faces_->of_face(Topology::face(t != none ? t : h));
}

bool is_long(const Mesh& mesh, const Camera& camera, double edge_pixels, EdgeId edge) {
  const auto end = [&](VertexId vertex) { return to_double(mesh.positions[vertex]); };
  const HalfEdgeId h = mesh.topology.half_edge[edge];
  return edge_pixels == 0 ||
         camera.projected_length(end(mesh.topology.origin[h]), end(mesh.topology.tip(h))) >= edge_pixels;
}

}  // namespace papilio
