#include "hierarchy/hierarchy.h"

#include <algorithm>

#include "hierarchy/transition.h"
#include "mesh/ranks.h"
#include "mesh/region.h"
#include "papilio/detail.h"
#include "rules/shape_rules.h"
#include "simd/vec3fa.h"
#include "split/split_in_four.h"

namespace papilio {
namespace {

int detail_levels_below(const HierarchyLevel& above) { return std::max(above.detail_levels - 1, 0); }

/// Splitter of some faces in four, leaving the other faces out.
class LevelMaker {
 public:
  LevelMaker(const HierarchyLevel& above, const Buffer<uint8_t>& red)
      : above_(above),
        mesh_(above.mesh.topology),
        faces_(with_neighbours(mesh_, red)),
        edges_(used_by_faces(faces_.numbers(), mesh_.edge, mesh_.edge_count())),
        vertices_(used_by_faces(faces_.numbers(), mesh_.origin, mesh_.vertex_count)) {}

  LevelBelow run(int threads) {
    Topology part = held_part();
    below_.mesh.topology = split_in_four(part, threads);
    make_vertices();
    below_.most_cosine = above_.most_cosine;
    below_.parent = faces_.numbers();
    below_.child.assign(mesh_.face_count(), none);
    for (uint32_t i = 0; i < faces_.count(); ++i) below_.child[faces_.numbers()[i]] = 4 * i;
    for (HalfEdgeId h : above_.shared)
      if (faces_.has(h.face())) {
        below_.shared.push_back(first_half(in_part(h)));
        below_.shared.push_back(second_half(in_part(h)));
      }
    carry_features();
    number_in_whole();
    return {std::move(below_), std::move(part)};
  }

 private:
  /// Returns the faces that get children, as a mesh of their own; where others are missing, edges are cut.
  [[nodiscard]] Topology held_part() const {
    Topology part;
    part.vertex_count = vertices_.count();
    const size_t half_edges = size_t{3} * faces_.count();
    part.origin.resize_for_overwrite(half_edges);
    part.twin.resize_for_overwrite(half_edges);
    part.edge.resize_for_overwrite(half_edges);
    part.half_edge.resize_for_overwrite(edges_.count());
    part.kind.resize_for_overwrite(edges_.count());
    uint32_t at = 0;
    for (FaceId f : faces_.numbers())
      for (uint32_t i = 0; i < 3; ++i, ++at) {
        const HalfEdgeId h = 3 * f + i;
        part.origin[at] = vertices_[mesh_.origin[h]];
        part.edge[at] = edges_[mesh_.edge[h]];
        part.twin[at] = in_part_or_none(mesh_.twin[h]);
      }
    name_half_edges(part);
    const auto carry = [&](const std::vector<uint32_t>& list, std::vector<uint32_t>& out) {
      for (VertexId v : list)
        if (vertices_.has(v)) out.push_back(vertices_[v]);
    };
    carry(mesh_.pinched, part.pinched);
    carry(mesh_.darts, part.darts);
    part.shape = {mesh_.shape.has_rules, mesh_.shape.is_mechanical, mesh_.shape.flat_distance, {}};
    carry(mesh_.shape.corners, part.shape.corners);
    return part;
  }

  /// Sets the kind and the half-edge of each edge: the half-edge of the level above if it is held, else another one.
  void name_half_edges(Topology& part) const {
    for (EdgeId e = 0; e < edges_.count(); ++e) {
      const HalfEdgeId h = mesh_.half_edge[edges_.numbers()[e]];
      const HalfEdgeId t = mesh_.twin[h];
      const uint32_t one = in_part_or_none(h);
      const uint32_t other = in_part_or_none(t);
      part.half_edge[e] = one != none ? one : other;
      part.kind[e] = t != none && (one == none || other == none) ? EdgeKind::cut : mesh_.kind[edges_.numbers()[e]];
    }
    for (HalfEdgeId h : above_.shared)
      if (faces_.has(h.face()) && part.half_edge[edges_[mesh_.edge[h]]] == none)
        part.half_edge[edges_[mesh_.edge[h]]] = in_part(h);
  }

  void make_vertices() {
    const uint32_t count = below_.mesh.topology.vertex_count;
    below_.mesh.positions.resize_for_overwrite(count);
    below_.complete.assign(count + 1, 1);  // the last entry is for vertices that are not held
    uint32_t at = 0;
    for (VertexId v : vertices_.numbers()) {
      below_.mesh.positions[at] = above_.mesh.positions[v];
      below_.complete[at++] = above_.complete[v];
    }
    for (EdgeId e : edges_.numbers()) below_.mesh.positions[at++] = above_.trial.at(e);
    for (FaceId f = 0; f < mesh_.face_count(); ++f) {
      if (faces_.has(f)) continue;
      for (HalfEdgeId h = 3 * f; h < 3 * f + 3; ++h) {
        below_.complete[std::min(vertices_[mesh_.origin[h]], count)] = 0;
        below_.complete[edges_.has(mesh_.edge[h]) ? new_vertex(mesh_.edge[h]) : count] = 0;
      }
    }
    below_.complete.pop_back();
  }

  /// Carries the features of held elements down, as descend() does.
  void carry_features() {
    const Features& above = above_.features;
    Features& out = below_.features;
    out.level = above.level + 1;
    out.has_darts = above.has_darts;
    for (size_t i = 0; i < above.fan_count(); ++i) {
      const VertexId centre = above.centre[i];
      if (!vertices_.has(centre) || below_.complete[vertices_[centre]] == 0) continue;
      for (const Features::Spoke& spoke : above.spokes_of(i))
        out.spokes.push_back({first_half(in_part(spoke.half_edge)),
                              2 * edges_[spoke.edge] + (centre > spoke.tip ? 1 : 0), new_vertex(spoke.edge)});
      out.first_spoke.push_back(static_cast<uint32_t>(out.spokes.size()));
      out.centre.push_back(vertices_[centre]);
      out.is_closed.push_back(above.is_closed[i]);
    }
    const Topology& below = below_.mesh.topology;
    for (HalfEdgeId h : above.curve_half_edges) {
      if (!faces_.has(h.face())) continue;
      if (below.kind[below.edge[first_half(in_part(h))]] == EdgeKind::cut) continue;  // a crease: one face is missing
      for (uint32_t half : {first_half(in_part(h)), second_half(in_part(h))}) out.curve_half_edges.push_back(half);
    }
  }

  void number_in_whole() {
    below_.detail_levels = detail_levels_below(above_);
    if (below_.detail_levels == 0) return;
    const WholeNumbers& above = above_.in_whole;
    const uint32_t edges_above = above_.is_whole ? mesh_.edge_count() : above.edge_count;
    const uint32_t faces_above = above_.is_whole ? mesh_.face_count() : above.face_count;
    WholeNumbers& out = below_.in_whole;
    out.edge_count = 2 * edges_above + 3 * faces_above;
    out.face_count = 4 * faces_above;
    out.edge.reserve(below_.mesh.topology.edge_count());
    for (uint32_t e : edges_.numbers())
      for (uint32_t half : {0U, 1U}) out.edge.push_back(2 * (above_.is_whole ? e : above.edge[e]) + half);
    out.parent.reserve(faces_.count());
    for (uint32_t f : faces_.numbers()) {
      out.parent.push_back(above_.is_whole ? f : 4 * above.parent[f / 4] + f % 4);
      for (uint32_t i = 0; i < 3; ++i) out.edge.push_back(2 * edges_above + 3 * out.parent.back() + i);
    }
  }

  /// Returns the number of the half-edge in the held part.
  [[nodiscard]] uint32_t in_part(HalfEdgeId h) const { return 3 * faces_[h.face()] + h % 3; }
  [[nodiscard]] uint32_t in_part_or_none(HalfEdgeId h) const {
    const FaceId face = faces_[h == none ? FaceId(0) : h.face()];  // branch-free: unpredictable
    const uint32_t missing = (h == none ? none : 0U) | (face == none ? none : 0U);
    static_assert(none == ~0U);
    return (3 * face + h % 3) | missing;
  }
  [[nodiscard]] uint32_t new_vertex(EdgeId e) const { return vertices_.count() + edges_[e]; }

  const HierarchyLevel& above_;
  const Topology& mesh_;
  const Ranks faces_, edges_, vertices_;
  HierarchyLevel below_;
};

}  // namespace

bool HierarchyLevel::is_complete(EdgeId edge) const {
  const Topology& t = mesh.topology;
  const HalfEdgeId h = t.half_edge[edge];
  const auto is_complete_at = [&](VertexId vertex) { return complete[vertex] != 0; };
  if (!is_complete_at(t.origin[h]) || !is_complete_at(t.tip(h))) return false;
  return !t.shape.has_rules || sides_of_strip(t, h)[0] == none ||
         (is_complete_at(t.apex(h)) && is_complete_at(t.apex(t.twin[h])));
}

uint64_t HierarchyLevel::bytes() const {
  const auto size = [](const auto&... vectors) { return (... + (vectors.capacity() * sizeof(vectors[0]))); };
  const Topology& t = mesh.topology;
  uint64_t bytes = size(t.origin, t.twin, t.edge, t.half_edge, t.kind, t.pinched, t.darts, mesh.positions) +
                   size(complete, parent, child, red, shared, longest) + size(trial.normals, trial.made) +
                   size(mesh.attributes.point);
  for (const Attribute& attribute : mesh.attributes.attributes) bytes += size(attribute.values);
  bytes += size(in_whole.edge, in_whole.parent);
  bytes += trial.deviations.bytes() + trial.bounds.bytes();
  bytes += size(features.curve_half_edges, features.spokes, features.first_spoke, features.centre, features.is_closed);
  return bytes;
}

HierarchyLevel coarsest_level(Mesh mesh) {
  HierarchyLevel level;
  level.is_whole = true;
  level.complete.assign(mesh.topology.vertex_count, 1);
  level.shared = shared_half_edges(mesh.topology);
  level.box = bounding_box(mesh.positions);
  level.features = find_features(mesh.topology);
  level.most_cosine = most_cosine_beside(smallest_angle(mesh));
  if (mesh.detail) level.detail_levels = mesh.detail->level_count();
  level.mesh = std::move(mesh);
  return level;
}

Marks edges_below_red(const HierarchyLevel& level) {
  if (level.is_whole) return complete_edges(level);
  const Topology& mesh = level.mesh.topology;
  Marks marks(mesh.edge_count(), 0);
  for (const uint8_t is_red : {1, 0})  // marks edges of red faces, then unmarks edges of the others
    for (uint32_t i = 0; i < mesh.face_count() / 4; ++i)
      if (level.red[level.parent_of(4 * i)] == is_red)
        for (HalfEdgeId h = 12 * i; h < 12 * i + 12; ++h) marks[mesh.edge[h]] = is_red;
  return marks;
}

Marks complete_edges(const HierarchyLevel& level) {
  Marks marks(level.mesh.topology.edge_count(), 1);
  if (level.is_whole) return marks;
  for (EdgeId e = 0; e < marks.size(); ++e) marks[e] = level.is_complete(e) ? 1 : 0;
  return marks;
}

Buffer<uint8_t> with_neighbours(const Topology& mesh, const Buffer<uint8_t>& faces) {
  Buffer<uint8_t> touched(mesh.vertex_count, 0);
  for (FaceId f : marked(faces))
    for (uint32_t i = 0; i < 3; ++i) touched[mesh.origin[3 * f + i]] = 1;
  Buffer<uint8_t> marks(faces.size());
  for (FaceId f = 0; f < faces.size(); ++f) marks[f] = is_touched(mesh, touched, f) ? 1 : 0;
  return marks;
}

namespace {

/// Returns the level below one all of whose edges were tried, its vertices numbered as by split_in_four().
HierarchyLevel level_by_formula(const HierarchyLevel& level, Topology topology) {
  HierarchyLevel below;
  below.mesh.positions.reserve(topology.vertex_count);
  below.mesh.positions = level.mesh.positions;
  below.mesh.positions.insert(below.mesh.positions.end(), level.trial.made.begin(), level.trial.made.end());
  below.mesh.topology = std::move(topology);
  below.most_cosine = level.most_cosine;
  return below;
}

/// Makes all of the next level.
HierarchyLevel refine_whole_level(const HierarchyLevel& level, Buffer<uint8_t> red, int threads) {
  HierarchyLevel below = level_by_formula(level, split_in_four(level.mesh.topology, threads));
  below.features = level.features;
  descend(below.features, level.mesh.topology.vertex_count);
  below.is_whole = true;
  below.detail_levels = detail_levels_below(level);
  below.complete.assign(below.mesh.topology.vertex_count, 1);
  for (uint32_t parent : level.shared)
    for (uint32_t half : {first_half(parent), second_half(parent)}) below.shared.push_back(half);
  below.red = std::move(red);
  below.box = bounding_box(below.mesh.positions);
  return below;
}

}  // namespace

LevelBelow refine_level(const HierarchyLevel& level, Buffer<uint8_t> red, int threads) {
  if (level.is_whole && std::ranges::find(red, 0) == red.end())
    return {refine_whole_level(level, std::move(red), threads), {}};
  LevelBelow below = LevelMaker(level, red).run(threads);
  below.level.red = std::move(red);
  below.level.box = bounding_box(below.level.mesh.positions);
  return below;
}

namespace {

/// Returns the box of the level above and the new vertices of `edges`.
Box box_with_new_vertices(const HierarchyLevel& above, const Buffer<uint32_t>& edges) {
  const auto& [min, max] = above.box;
  Vec3fa least{{min.x, min.y, min.z, 0}};
  Vec3fa most{{max.x, max.y, max.z, 0}};
  for (EdgeId e : edges) {
    const Vec3fa p = widen(above.trial.made[e]);
    least = lesser(p, least);
    most = larger(p, most);
  }
  Box box;
  store(least, box.min);
  store(most, box.max);
  return box;
}

}  // namespace

HierarchyLevel refine_last_level(const HierarchyLevel& level, Buffer<uint8_t> red, const Part& part, int threads) {
  HierarchyLevel below = level_by_formula(level, split_part_in_four(level.mesh.topology, part, threads));
  below.parent = part.faces.numbers();
  below.parent.push_back(none);
  below.child.resize(red.size());
  for (FaceId f = 0; f < red.size(); ++f) below.child[f] = 4 * part.faces[f];
  below.red = std::move(red);
  below.box = box_with_new_vertices(level, part.edges.numbers());
  return below;
}

}  // namespace papilio
