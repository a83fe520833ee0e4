#include "hierarchy.h"

#include <algorithm>
#include <numeric>

#include "split_in_four.h"
#include "split_pattern.h"

namespace papilio {
namespace {

/// Numbers the marked things in their order; `none` for the others.
class Ranks {
 public:
  explicit Ranks(const List<uint8_t>& marks) : rank_(marks.size(), none) {
    for (size_t i = 0; i < marks.size(); ++i)
      if (marks[i] != 0) rank_[i] = count_++;
  }
  [[nodiscard]] uint32_t operator[](uint32_t i) const { return rank_[i]; }
  [[nodiscard]] bool has(uint32_t i) const { return rank_[i] != none; }
  [[nodiscard]] uint32_t count() const { return count_; }

 private:
  List<uint32_t> rank_;
  uint32_t count_ = 0;
};

/// Splits faces in four, as split() does where all are split, leaving the other faces out.
class LevelMaker {
 public:
  LevelMaker(const HierarchyLevel& above, const List<uint8_t>& red)
      : above_(above),
        mesh_(above.mesh.topology),
        support_(with_neighbours(mesh_, red)),
        faces_(support_),
        edges_(used_edges()),
        vertices_(used_vertices()) {}

  HierarchyLevel run() {
    make_vertices();
    make_edges();
    make_faces();
    note_shared();
    return std::move(below_);
  }

 private:
  [[nodiscard]] List<uint8_t> used_edges() const {
    List<uint8_t> used(mesh_.edge_count(), 0);
    for (uint32_t h = 0; h < mesh_.half_edge_count(); ++h)
      if (support_[Topology::face(h)] != 0) used[mesh_.edge[h]] = 1;
    return used;
  }
  [[nodiscard]] List<uint8_t> used_vertices() const {
    List<uint8_t> used(mesh_.vertex_count, 0);
    for (uint32_t h = 0; h < mesh_.half_edge_count(); ++h)
      if (support_[Topology::face(h)] != 0) used[mesh_.origin[h]] = 1;
    return used;
  }

  void make_vertices() {
    const uint32_t count = vertices_.count() + edges_.count();
    below_.mesh.topology.vertex_count = count;
    below_.mesh.positions.resize(count);
    below_.from.resize(count);
    below_.complete.assign(count, 1);
    for (uint32_t v = 0; v < mesh_.vertex_count; ++v) {
      if (!vertices_.has(v)) continue;
      below_.mesh.positions[vertices_[v]] = above_.mesh.positions[v];
      below_.from[vertices_[v]] = v;
      below_.complete[vertices_[v]] = above_.complete[v];
    }
    for (uint32_t e = 0; e < mesh_.edge_count(); ++e) {
      if (!edges_.has(e)) continue;
      below_.mesh.positions[new_vertex(e)] = above_.trial.at(e);
      below_.from[new_vertex(e)] = mesh_.vertex_count + e;
    }
    for (uint32_t h = 0; h < mesh_.half_edge_count(); ++h) {
      if (faces_.has(Topology::face(h))) continue;
      if (vertices_.has(mesh_.origin[h])) below_.complete[vertices_[mesh_.origin[h]]] = 0;
      if (edges_.has(mesh_.edge[h])) below_.complete[new_vertex(mesh_.edge[h])] = 0;
    }
    const auto carry = [&](const std::vector<uint32_t>& list, std::vector<uint32_t>& out) {
      for (uint32_t v : list)
        if (vertices_.has(v)) out.push_back(vertices_[v]);
    };
    carry(mesh_.pinched, below_.mesh.topology.pinched);
    carry(mesh_.darts, below_.mesh.topology.darts);
  }

  void make_edges() {
    Topology& out = below_.mesh.topology;
    const uint32_t count = 2 * edges_.count() + 3 * faces_.count();
    out.kind.assign(count, EdgeKind::smooth);
    out.half_edge.assign(count, none);
    for (uint32_t e = 0; e < mesh_.edge_count(); ++e) {
      if (!edges_.has(e)) continue;
      const EdgeKind kind = kind_below(e);
      out.kind[2 * edges_[e]] = kind;
      out.kind[2 * edges_[e] + 1] = kind;
    }
  }

  /// An edge of two faces one of which is missing is cut.
  [[nodiscard]] EdgeKind kind_below(uint32_t e) const {
    const uint32_t h = mesh_.half_edge[e];
    const uint32_t t = mesh_.twin[h];
    if (t == none) return mesh_.kind[e];
    return faces_.has(Topology::face(h)) && faces_.has(Topology::face(t)) ? mesh_.kind[e] : EdgeKind::cut;
  }

  void make_faces() {
    Topology& out = below_.mesh.topology;
    const size_t count = size_t{12} * faces_.count();
    out.origin.resize(count);
    out.twin.resize(count);
    out.edge.resize(count);
    below_.parent.resize(faces_.count());
    below_.child.assign(mesh_.face_count(), none);
    for (uint32_t f = 0; f < mesh_.face_count(); ++f) {
      if (!faces_.has(f)) continue;
      below_.child[f] = 4 * faces_[f];
      below_.parent[faces_[f]] = f;
      split_face(f);
    }
  }

  void split_face(uint32_t f) {
    static const SplitPattern& red = split_pattern(7, false);
    Topology& out = below_.mesh.topology;
    const uint32_t base = 12 * faces_[f];
    for (uint32_t c = 0; c < 12; ++c) {
      const uint32_t h = base + c;
      const uint8_t corner = red.corner[c / 3][c % 3];
      out.origin[h] =
          corner < 3 ? vertices_[mesh_.origin[3 * f + corner]] : new_vertex(mesh_.edge[3 * f + corner - 3U]);
      if (red.inner_twin[c] != SplitPattern::outside) {
        out.twin[h] = base + red.inner_twin[c];
        out.edge[h] = 2 * edges_.count() + 3 * faces_[f] + red.edge[c];
        out.half_edge[out.edge[h]] = h;
      } else {
        const uint32_t parent = 3 * f + red.edge[c] / 2;
        const uint32_t half = red.edge[c] % 2;
        out.twin[h] = outer_twin(parent, half);
        // The half at the lower vertex comes first, whichever way the half-edge runs.
        const bool up = mesh_.origin[parent] < mesh_.tip(parent);
        out.edge[h] = 2 * edges_[mesh_.edge[parent]] + (up ? half : 1 - half);
        // Edges name the half-edges that they name where everything is held.
        uint32_t& named = out.half_edge[out.edge[h]];
        if (named == none || mesh_.half_edge[mesh_.edge[parent]] == parent) named = h;
      }
    }
  }

  void note_shared() {
    for (uint32_t parent : above_.shared) {
      if (!faces_.has(Topology::face(parent))) continue;
      for (uint32_t half = 0; half < 2; ++half)
        below_.shared.push_back(12 * faces_[Topology::face(parent)] +
                                split_pattern(7, false).outer[2 * (parent % 3) + half]);
    }
  }

  [[nodiscard]] uint32_t outer_twin(uint32_t h, uint32_t half) const {
    static const SplitPattern& red = split_pattern(7, false);
    const uint32_t t = mesh_.twin[h];
    if (t == none || !faces_.has(Topology::face(t))) return none;
    return 12 * faces_[Topology::face(t)] + red.outer[2 * (t % 3) + 1 - half];
  }

  [[nodiscard]] uint32_t new_vertex(uint32_t e) const { return vertices_.count() + edges_[e]; }

  const HierarchyLevel& above_;
  const Topology& mesh_;
  const List<uint8_t> support_;
  const Ranks faces_, edges_, vertices_;
  HierarchyLevel below_;
};

}  // namespace

bool HierarchyLevel::is_complete(uint32_t edge) const {
  const uint32_t h = mesh.topology.half_edge[edge];
  return complete[mesh.topology.origin[h]] != 0 && complete[mesh.topology.tip(h)] != 0;
}

uint64_t HierarchyLevel::bytes() const {
  const auto size = [](const auto&... vectors) { return (... + (vectors.capacity() * sizeof(vectors[0]))); };
  const Topology& t = mesh.topology;
  uint64_t bytes = size(t.origin, t.twin, t.edge, t.half_edge, t.kind, t.pinched, t.darts, mesh.positions) +
                   size(complete, from, parent, child, red, shared, longest) +
                   size(trial.normals, trial.tried.before, trial.made) + size(mesh.attributes.point);
  for (const Attribute& attribute : mesh.attributes.attributes) bytes += size(attribute.values);
  bytes += trial.deviations.bytes() + trial.bounds.bytes() + transitions.bytes() + trial.planes.bytes() +
           trial.products.bytes();
  bytes += size(features.curve_half_edges, features.spokes, features.first_spoke, features.centre, features.is_closed);
  return bytes;
}

HierarchyLevel coarsest_level(Mesh mesh) {
  HierarchyLevel level;
  level.is_whole = true;
  level.complete.assign(mesh.topology.vertex_count, 1);
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
    if (mesh.topology.kind[mesh.topology.edge[h]] == EdgeKind::shared) level.shared.push_back(h);
  level.transitions = Memo<uint32_t>(mesh.topology.face_count(), 0);
  level.box = bounding_box(mesh.positions);
  level.features = find_features(mesh.topology);
  level.mesh = std::move(mesh);
  return level;
}

EdgeMarks edges_below_red(const HierarchyLevel& level) {
  EdgeMarks marks = complete_edges(level);
  if (level.is_whole) return marks;
  const Topology& mesh = level.mesh.topology;
  for (uint32_t h = 0; h < mesh.half_edge_count(); ++h)
    if (level.red[level.parent[h / 12]] == 0) marks[mesh.edge[h]] = 0;
  return marks;
}

EdgeMarks complete_edges(const HierarchyLevel& level) {
  EdgeMarks marks(level.mesh.topology.edge_count(), 1);
  if (level.is_whole) return marks;
  for (uint32_t e = 0; e < marks.size(); ++e) marks[e] = level.is_complete(e) ? 1 : 0;
  return marks;
}

List<uint8_t> with_neighbours(const Topology& mesh, const List<uint8_t>& faces) {
  List<uint8_t> touched(mesh.vertex_count, 0);
  for (uint32_t h = 0; h < mesh.half_edge_count(); ++h)
    if (faces[Topology::face(h)] != 0) touched[mesh.origin[h]] = 1;
  List<uint8_t> marks(faces.size(), 0);
  for (uint32_t h = 0; h < mesh.half_edge_count(); ++h)
    if (touched[mesh.origin[h]] != 0) marks[Topology::face(h)] = 1;
  return marks;
}

namespace {

List<uint32_t> numbers(size_t count) {
  List<uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

/// What LevelMaker makes where everything is held, by formula.
HierarchyLevel refine_whole_level(const HierarchyLevel& level, int threads) {
  const Topology& mesh = level.mesh.topology;
  HierarchyLevel below;
  below.is_whole = true;
  below.features = level.features;
  descend(below.features, mesh);
  below.mesh.topology = split_in_four(mesh, threads);
  below.mesh.positions.reserve(below.mesh.topology.vertex_count);
  below.mesh.positions = level.mesh.positions;
  below.mesh.positions.insert(below.mesh.positions.end(), level.trial.made.begin(), level.trial.made.end());
  below.complete.assign(below.mesh.topology.vertex_count, 1);
  below.from = numbers(below.mesh.topology.vertex_count);
  below.parent = numbers(mesh.face_count());
  below.child.resize(mesh.face_count());
  for (uint32_t f = 0; f < mesh.face_count(); ++f) below.child[f] = 4 * f;
  for (uint32_t parent : level.shared)
    for (uint32_t half : {first_half(parent), second_half(parent)}) below.shared.push_back(half);
  return below;
}

}  // namespace

HierarchyLevel refine_level(const HierarchyLevel& level, List<uint8_t> red, int threads) {
  const bool all = level.is_whole && level.trial.made.size() == level.mesh.topology.edge_count() &&
                   std::ranges::find(red, 0) == red.end();
  HierarchyLevel below = all ? refine_whole_level(level, threads) : LevelMaker(level, red).run();
  below.red = std::move(red);
  below.transitions = Memo<uint32_t>(below.mesh.topology.face_count(), 0);
  below.box = bounding_box(below.mesh.positions);
  return below;
}

}  // namespace papilio
