#include "criteria/view_culling.h"

#include <algorithm>
#include <bit>
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
        quick_(camera, box),
        through_(camera.planes_through(box)),
        quick_outside_(camera, box, through_),
        inside_(through_ == 0 ? 0 : mesh.topology.vertex_count, unknown) {}

  /// What of the above holds for a face.
  [[nodiscard]] uint8_t of_face(uint32_t f) {
    uint8_t sight = is_face_away(f) ? 0 : is_towards;
    return sight | (is_inside_somewhere(f) ? is_inside : 0);
  }
  /// The same of four faces, the children of one (four_children.h), from their first. Not before all vertices were
  /// looked at.
  void of_four(uint32_t first, uint8_t* sights) const {
    const std::array<uint32_t, 6> vertex = vertices_of_four(&mesh_.topology.origin[size_t{3} * first]);
    std::array<Vec3fa, 6> p;
    std::array<uint8_t, 6> in;
    for (uint32_t i = 0; i < 6; ++i) {
      p[i] = widen(mesh_.positions[vertex[i]]);
      in[i] = inside_[vertex[i]];
    }
    const Vec3x4 normals = at(normals_, {first, first + 1, first + 2, first + 3});
    const Vec3x4 centroids =
        (1.0F / 3) * transposed(p[0] + p[3] + p[5], p[3] + p[1] + p[4], p[5] + p[4] + p[2], p[3] + p[4] + p[5]);
    const auto [are_towards, are_away] = quick_(normals, dot(normals, centroids));
    auto is_away = std::bit_cast<std::array<uint32_t, 4>>(are_away);
    if (!is_all(are_towards | are_away)) [[unlikely]]
      for (uint32_t i = 0; i < 4; ++i) is_away[i] = is_face_away(first + i) ? ~0U : 0;
    put_sight(is_away[0], in[0] | in[3] | in[5], sights);
    put_sight(is_away[1], in[3] | in[1] | in[4], sights + 1);
    put_sight(is_away[2], in[5] | in[4] | in[2], sights + 2);
    put_sight(is_away[3], in[3] | in[4] | in[5], sights + 3);
  }
  /// Finds what will be asked of vertices at once, where most of them will be: in their order that costs less.
  void look_at_vertices() {
    if (through_ == 0) inside_.assign(mesh_.topology.vertex_count, is_inside);
    for (uint32_t v = 0; v < inside_.size(); ++v) {
      const Camera::Answer is_outside = quick_outside_(mesh_.positions[v], static_cast<float>(longest_[v]));
      if (is_outside == Camera::Answer::unsure)
        (void)is_vertex_inside(v);
      else
        inside_[v] = is_outside == Camera::Answer::no ? is_inside : 0;
    }
  }

 private:
  static constexpr uint8_t unknown = 2;

  /// `away`: all bits, or none.
  static void put_sight(uint32_t away, int inside, uint8_t* sight) {
    *sight = static_cast<uint8_t>((~away & is_towards) | static_cast<uint32_t>(inside));
  }
  [[nodiscard]] Vec3d position(uint32_t v) const { return to_double(mesh_.positions[v]); }
  [[nodiscard]] bool is_vertex_inside(uint32_t v) {
    if (inside_[v] == unknown) inside_[v] = camera_.is_outside(position(v), longest_[v], through_) ? 0 : is_inside;
    return inside_[v] != 0;
  }
  [[nodiscard]] bool is_inside_somewhere(uint32_t f) {
    if (through_ == 0) return true;
    const uint32_t* corner = &mesh_.topology.origin[size_t{3} * f];
    const bool are_inside[3] = {is_vertex_inside(corner[0]), is_vertex_inside(corner[1]), is_vertex_inside(corner[2])};
    return are_inside[0] | are_inside[1] | are_inside[2];
  }
  [[nodiscard]] bool is_face_away(uint32_t f) const {
    const uint32_t* corner = &mesh_.topology.origin[size_t{3} * f];
    const Vec3d centroid = (1.0 / 3) * (position(corner[0]) + position(corner[1]) + position(corner[2]));
    return has_normal(normals_[f]) && camera_.is_away(centroid, to_double(normals_[f]));
  }

  const Mesh& mesh_;
  const Buffer<Vec3f>& normals_;
  const Buffer<double>& longest_;
  const Camera& camera_;
  const Camera::QuickAway quick_;
  const unsigned through_;  ///< the planes that some of the mesh may be outside of
  const Camera::QuickOutside quick_outside_;
  Buffer<uint8_t> inside_;  ///< [V] is_inside, or 0, or unknown; empty where all are and nobody has looked
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
    if (!of_shared_.empty() && mesh_.kind[e] == EdgeKind::shared) return of_shared_[e] == seen;
    const uint32_t h = mesh_.half_edge[e];
    const uint32_t t = mesh_.twin[h];
    return (of_face(Topology::face(h)) | of_face(Topology::face(t != none ? t : h))) == seen;
  }

  /// The faces are all those at the edges.
  void keep_shown_once_all_are_looked_at(const Region& region, Buffer<uint32_t>& edges) {
    look_at(region);
    keep_if(edges, [this, has_shared = !of_shared_.empty()](uint32_t e) {
      const uint32_t h = mesh_.half_edge[e];
      const uint32_t t = mesh_.twin[h];
      const int sight = of_face_[Topology::face(h)] | of_face_[Topology::face(t != none ? t : h)];
      return has_shared ? is_shown(e) : sight == seen;
    });
  }

 private:
  static constexpr uint8_t unknown = 255;
  void look_at(const Region& region) {
    const Buffer<uint32_t>& faces = region.faces;
    const bool are_many = faces.size() > mesh_.vertex_count;
    if (are_many) sight_.look_at_vertices();
    if (are_many && region.is_in_fours)
      for (size_t i = 0; i < faces.size(); i += 4) sight_.of_four(faces[i], &of_face_[faces[i]]);
    else
      for (uint32_t f : faces) (void)of_face(f);
  }
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
  if (memory_ == nullptr) return;
  Memory& memory = *memory_;
  constexpr size_t many = 3;  // so many for four faces: about every second edge
  if (edges.size() * 4 > region.faces.size() * many)
    memory.keep_shown_once_all_are_looked_at(region, edges);
  else
    keep_if(edges, [&](uint32_t e) { return memory.is_shown(e); });
}

void keep_long(const Mesh& mesh, const Camera& camera, double edge_pixels, Buffer<uint32_t>& edges) {
  if (edge_pixels == 0) return;
  const auto end = [&](uint32_t vertex) { return to_double(mesh.positions[vertex]); };
  keep_if(edges, [&](uint32_t e) {
    const uint32_t h = mesh.topology.half_edge[e];
    return !camera.looks_shorter(end(mesh.topology.origin[h]), end(mesh.topology.tip(h)), edge_pixels);
  });
}

}  // namespace papilio
