#include "criteria/view_culling.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/four_children.h"
#include "mesh/normals.h"

namespace papilio {
namespace {

enum : uint8_t { is_inside = 1, is_towards = 2, seen = 3 };

/// Visibility of faces in the view.
class FaceVisibility {
 public:
  /// `longest` [V] edges; `box` of the vertices.
  FaceVisibility(const Mesh& mesh, const Buffer<Vec3f>& normals, const Buffer<double>& longest, const Box& box,
                 const Camera& camera)
      : mesh_(mesh),
        normals_(normals),
        longest_(longest),
        camera_(camera),
        planes_(camera.planes_through(box)),
        inside_(planes_.empty() ? 0 : mesh.topology.vertex_count, unknown) {}

  /// Returns which of the bits `is_towards` and `is_inside` hold for a face.
  [[nodiscard]] uint8_t of_face(FaceId f) {
    uint8_t visibility = is_face_away(f) ? 0 : is_towards;
    return visibility | (is_inside_somewhere(f) ? is_inside : 0);
  }
  /// Tests all vertices at once, in their order: cheaper if most of them will be tested.
  void test_vertices() {
    for (VertexId v = 0; v < inside_.size(); ++v)
      inside_[v] = Camera::is_outside(planes_, position(v), longest_[v]) ? 0 : is_inside;
  }

 private:
  static constexpr uint8_t unknown = 2;

  [[nodiscard]] Vec3d position(VertexId v) const { return to_double(mesh_.positions[v]); }
  [[nodiscard]] bool is_vertex_inside(VertexId v) {
    if (inside_[v] == unknown) inside_[v] = Camera::is_outside(planes_, position(v), longest_[v]) ? 0 : is_inside;
    return inside_[v] != 0;
  }
  [[nodiscard]] bool is_inside_somewhere(FaceId f) {
    if (planes_.empty()) return true;
    const uint32_t* corner = &mesh_.topology.origin[size_t{3} * f];
    const bool are_inside[3] = {is_vertex_inside(corner[0]), is_vertex_inside(corner[1]), is_vertex_inside(corner[2])};
    return are_inside[0] | are_inside[1] | are_inside[2];
  }
  [[nodiscard]] bool is_face_away(FaceId f) const {
    if (camera_.shows_backs()) return false;
    const uint32_t* corner = &mesh_.topology.origin[size_t{3} * f];
    const Vec3d centroid = (1.0 / 3) * (position(corner[0]) + position(corner[1]) + position(corner[2]));
    return has_normal(normals_[f]) && camera_.is_away(centroid, to_double(normals_[f]));
  }

  const Mesh& mesh_;
  const Buffer<Vec3f>& normals_;
  const Buffer<double>& longest_;
  const Camera& camera_;
  const std::vector<Camera::Plane> planes_;  ///< planes that part of the mesh may be outside of
  Buffer<uint8_t> inside_;                   ///< [V] `is_inside`, 0 or `unknown`; empty if all are inside
};

}  // namespace

std::vector<bool> hidden_faces(const Mesh& mesh, const Buffer<Vec3f>& normals, const Camera& camera) {
  const Buffer<double> longest = longest_edges(mesh);
  FaceVisibility visibility(mesh, normals, longest, bounding_box(mesh.positions), camera);
  std::vector<bool> hidden(mesh.topology.face_count());
  for (FaceId f = 0; f < hidden.size(); ++f) hidden[f] = visibility.of_face(f) != seen;
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
    longest[a] = std::max(longest[a], squared);
    longest[b] = std::max(longest[b], squared);
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
      squared[from] = std::max(squared[from], squared_length);
      squared[to] = std::max(squared[to], squared_length);
    });
    for (uint32_t i = 0; i < 6; ++i) longest[vertex[i]] = std::max(longest[vertex[i]], squared[i]);
  }
  for (double& l : longest) l = std::sqrt(l);
  return longest;
}

/// Cache of the bits of faces.
class EdgesShown::Cache {
 public:
  Cache(const Mesh& mesh, FaceVisibility visibility)
      : mesh_(mesh.topology), visibility_(std::move(visibility)), of_face_(mesh_.face_count(), 0) {}

  [[nodiscard]] const Topology& mesh() const { return mesh_; }
  [[nodiscard]] uint8_t of_face(FaceId f) {
    if (of_face_[f] == 0) of_face_[f] = is_known | visibility_.of_face(f);
    return of_face_[f];
  }
  /// Tests a region's faces in their order: cheaper if most of its edges will be tested.
  void test(const Region& region, uint8_t* of_edge) {
    if (region.faces.size() > mesh_.vertex_count) visibility_.test_vertices();
    const uint32_t* const edges = mesh_.edge.data();
    for (FaceId f : region.faces) {
      const uint8_t visibility = visibility_.of_face(f);
      for (EdgeId e : {edges[3 * f], edges[3 * f + 1], edges[3 * f + 2]})
        of_edge[e] |= visibility | region.has_edge[e] * is_known;
    }
  }

 private:
  const Topology& mesh_;
  FaceVisibility visibility_;
  Buffer<uint8_t> of_face_;  ///< [F] bits of the face, and `is_known`; 0 if not tested
};

EdgesShown::EdgesShown() = default;
EdgesShown::EdgesShown(const Mesh& mesh, const Buffer<Vec3f>& normals, const Buffer<double>& longest, const Box& box,
                       const Camera& camera, const Buffer<uint32_t>& shared)
    : cache_(std::make_unique<Cache>(mesh, FaceVisibility(mesh, normals, longest, box, camera))),
      of_edge_(mesh.topology.edge_count(), 0) {
  for (HalfEdgeId h : shared) of_edge_[mesh.topology.edge[h]] |= cache_->of_face(h.face());
}
EdgesShown::EdgesShown(EdgesShown&& other) noexcept = default;
EdgesShown& EdgesShown::operator=(EdgesShown&& other) noexcept = default;
EdgesShown::~EdgesShown() = default;

uint8_t EdgesShown::find(EdgeId edge) const {
  const HalfEdgeId h = cache_->mesh().half_edge[edge];
  const HalfEdgeId t = cache_->mesh().twin[h];
  return of_edge_[edge] = cache_->of_face(h.face()) | cache_->of_face(Topology::face(t != none ? t : h));
}

void EdgesShown::keep_shown(const Region& region, Buffer<uint32_t>& edges) const {
  constexpr size_t many = 3;  // edges for four faces: about every second edge
  if (cache_ == nullptr) return;
  if (edges.size() * 4 > region.faces.size() * many) cache_->test(region, of_edge_.data());
  keep_if(edges, [this](EdgeId e) { return (*this)[e]; });
}

bool is_long(const Mesh& mesh, const Camera& camera, double edge_pixels, EdgeId edge) {
  const auto end = [&](VertexId vertex) { return to_double(mesh.positions[vertex]); };
  const HalfEdgeId h = mesh.topology.half_edge[edge];
  return edge_pixels == 0 ||
         camera.projected_length(end(mesh.topology.origin[h]), end(mesh.topology.tip(h))) >= edge_pixels;
}

void keep_long(const Mesh& mesh, const Camera& camera, double edge_pixels, Buffer<uint32_t>& edges) {
  if (edge_pixels > 0) keep_if(edges, [&](EdgeId e) { return is_long(mesh, camera, edge_pixels, e); });
}

}  // namespace papilio
