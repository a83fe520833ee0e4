#include "criteria/view_culling.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/index_range.h"
#include "mesh/four_children.h"
#include "mesh/normals.h"

namespace papilio {
namespace {

enum : uint8_t { is_inside = 1, is_towards = 2, seen = 3 };

/// Which faces the view shows.
class Sight {
 public:
  /// `longest` [V] edges; `box` of the vertices.
  Sight(const Mesh& mesh, const Buffer<Vec3f>& normals, const Buffer<double>& longest, const Box& box,
        const Camera& camera)
      : mesh_(mesh),
        normals_(normals),
        longest_(longest),
        camera_(camera),
        planes_(camera.planes_through(box)),
        inside_(planes_.empty() ? 0 : mesh.topology.vertex_count, unknown) {}

  /// What of the above holds for a face.
  [[nodiscard]] uint8_t of_face(uint32_t f) {
    uint8_t sight = is_face_away(f) ? 0 : is_towards;
    return sight | (is_inside_somewhere(f) ? is_inside : 0);
  }
  /// Finds what will be asked of vertices at once, where most of them will be: in their order that costs less.
  void look_at_vertices() {
    for (uint32_t v = 0; v < inside_.size(); ++v)
      inside_[v] = Camera::is_outside(planes_, position(v), longest_[v]) ? 0 : is_inside;
  }

 private:
  static constexpr uint8_t unknown = 2;

  [[nodiscard]] Vec3d position(uint32_t v) const { return to_double(mesh_.positions[v]); }
  [[nodiscard]] bool is_vertex_inside(uint32_t v) {
    if (inside_[v] == unknown) inside_[v] = Camera::is_outside(planes_, position(v), longest_[v]) ? 0 : is_inside;
    return inside_[v] != 0;
  }
  [[nodiscard]] bool is_inside_somewhere(uint32_t f) {
    if (planes_.empty()) return true;
    const uint32_t* corner = &mesh_.topology.origin[size_t{3} * f];
    const bool are_inside[3] = {is_vertex_inside(corner[0]), is_vertex_inside(corner[1]), is_vertex_inside(corner[2])};
    return are_inside[0] | are_inside[1] | are_inside[2];
  }
  [[nodiscard]] bool is_face_away(uint32_t f) const {
    if (camera_.shows_backs()) return false;
    const uint32_t* corner = &mesh_.topology.origin[size_t{3} * f];
    const Vec3d centroid = (1.0 / 3) * (position(corner[0]) + position(corner[1]) + position(corner[2]));
    return has_normal(normals_[f]) && camera_.is_away(centroid, to_double(normals_[f]));
  }

  const Mesh& mesh_;
  const Buffer<Vec3f>& normals_;
  const Buffer<double>& longest_;
  const Camera& camera_;
  const std::vector<Camera::Plane> planes_;  ///< that some of the mesh may be outside of
  Buffer<uint8_t> inside_;                   ///< [V] is_inside, or 0, or unknown; empty where all are
};

}  // namespace

std::vector<bool> hidden_faces(const Mesh& mesh, const Buffer<Vec3f>& normals, const Camera& camera) {
  const Buffer<double> longest = longest_edges(mesh);
  Sight sight(mesh, normals, longest, bounding_box(mesh.positions), camera);
  std::vector<bool> hidden(mesh.topology.face_count());
  for (uint32_t f = 0; f < hidden.size(); ++f) hidden[f] = sight.of_face(f) != seen;
  return hidden;
}

Buffer<double> longest_edges(const Mesh& mesh) {
  const Topology& topology = mesh.topology;
  Buffer<double> longest(topology.vertex_count, 0);
  for (uint32_t e = 0; e < topology.edge_count(); ++e) {
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

Buffer<double> longest_edges_below(const Topology& parents, const Buffer<Vec3f>& positions,
                                   const Buffer<uint32_t>* faces) {
  const IndexRange of(parents.face_count(), faces);
  Buffer<double> longest(positions.size(), 0);
  for (uint32_t k = 0; k < of.size(); ++k) {
    const uint32_t* corner = &parents.origin[size_t{3} * of[k]];
    const uint32_t* edge = &parents.edge[size_t{3} * of[k]];
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

/// What was found of faces already.
class EdgesShown::Memory {
 public:
  Memory(const Mesh& mesh, Sight sight, const Buffer<uint32_t>& shared)
      : mesh_(mesh.topology), sight_(std::move(sight)), of_face_(mesh_.face_count(), unknown) {
    if (shared.empty()) return;
    of_shared_.assign(mesh_.edge_count(), 0);
    for (uint32_t h : shared) of_shared_[mesh_.edge[h]] |= of_face(Topology::face(h));
  }

  [[nodiscard]] bool is_shown(uint32_t e) {
    const uint32_t h = mesh_.half_edge[e];
    const uint32_t t = mesh_.twin[h];
    (void)of_face(Topology::face(h));
    (void)of_face(Topology::face(t != none ? t : h));
    return is_known_to_be_shown(e);
  }

  /// Looks at faces in their order, which costs less where most will be asked for.
  void look_at(const Buffer<uint32_t>& faces) {
    if (faces.size() > mesh_.vertex_count) sight_.look_at_vertices();
    for (uint32_t f : faces) of_face_[f] = sight_.of_face(f);
  }
  /// The same of an edge whose faces were looked at.
  [[nodiscard]] bool is_known_to_be_shown(uint32_t e) const {
    if (!of_shared_.empty() && mesh_.kind[e] == EdgeKind::shared) return of_shared_[e] == seen;
    const uint32_t h = mesh_.half_edge[e];
    const uint32_t t = mesh_.twin[h];
    return (of_face_[Topology::face(h)] | of_face_[Topology::face(t != none ? t : h)]) == seen;
  }

 private:
  static constexpr uint8_t unknown = 255;
  [[nodiscard]] uint8_t of_face(uint32_t f) {
    if (of_face_[f] == unknown) of_face_[f] = sight_.of_face(f);
    return of_face_[f];
  }

  const Topology& mesh_;
  Sight sight_;
  Buffer<uint8_t> of_face_;    ///< [F] or unknown
  Buffer<uint8_t> of_shared_;  ///< [E] of shared edges' faces together; empty where there are none
};

EdgesShown::EdgesShown() = default;
EdgesShown::EdgesShown(const Mesh& mesh, const Buffer<Vec3f>& normals, const Buffer<double>& longest, const Box& box,
                       const Camera& camera, const Buffer<uint32_t>& shared)
    : memory_(std::make_unique<Memory>(mesh, Sight(mesh, normals, longest, box, camera), shared)) {}
EdgesShown::EdgesShown(EdgesShown&& other) noexcept = default;
EdgesShown& EdgesShown::operator=(EdgesShown&& other) noexcept = default;
EdgesShown::~EdgesShown() = default;

bool EdgesShown::operator[](uint32_t edge) const { return memory_ == nullptr || memory_->is_shown(edge); }

void EdgesShown::keep_shown(const Region& region, Buffer<uint32_t>& edges) const {
  constexpr size_t many = 3;  // so many for four faces: about every second edge
  if (memory_ == nullptr) return;
  const Memory& memory = *memory_;
  if (edges.size() * 4 > region.faces.size() * many) {
    memory_->look_at(region.faces);
    keep_if(edges, [&](uint32_t e) { return memory.is_known_to_be_shown(e); });
  } else {
    keep_if(edges, [&](uint32_t e) { return memory_->is_shown(e); });
  }
}

bool is_long(const Mesh& mesh, const Camera& camera, double edge_pixels, uint32_t edge) {
  const auto end = [&](uint32_t vertex) { return to_double(mesh.positions[vertex]); };
  const uint32_t h = mesh.topology.half_edge[edge];
  return edge_pixels == 0 ||
         !camera.looks_shorter(end(mesh.topology.origin[h]), end(mesh.topology.tip(h)), edge_pixels);
}

void keep_long(const Mesh& mesh, const Camera& camera, double edge_pixels, Buffer<uint32_t>& edges) {
  if (edge_pixels > 0) keep_if(edges, [&](uint32_t e) { return is_long(mesh, camera, edge_pixels, e); });
}

}  // namespace papilio
