#include "assemble.h"

#include <algorithm>
#include <map>
#include <utility>

#include "attributes.h"
#include "transition.h"

namespace papilio {
namespace {

/// What becomes of a level's faces.
struct Fate {
  static constexpr uint8_t hidden = 255;   ///< not in the result, nor its children
  static constexpr uint8_t divided = 254;  ///< its children are
  SplitPlan split;
  std::vector<uint8_t> face;      ///< [F] hidden, divided, or the number of its pattern
  std::vector<uint32_t> first;    ///< [F] where its faces begin in the result; meaningless where hidden
  std::vector<uint32_t> vertex;   ///< [V] number in the result; `none` where not used
  uint32_t first_new_vertex = 0;  ///< number of the first vertex made on this level's edges

  [[nodiscard]] bool is_shown(uint32_t f) const { return face[f] != hidden; }
  [[nodiscard]] bool is_divided(uint32_t f) const { return face[f] == divided; }
};

class Assembler {
 public:
  explicit Assembler(std::span<const HierarchyLevel> levels) : levels_(levels) {
    for (size_t k = 0; k < levels.size(); ++k) decide(k);
    place();
  }

  Mesh run() {
    const Topology& coarse = levels_[0].mesh.topology;
    Topology& topology = out_.topology;
    topology.vertex_count = fates_.back().first_new_vertex + fates_.back().split.count();
    topology.pinched = coarse.pinched;
    topology.darts = coarse.darts;
    topology.origin.resize(size_t{3} * face_count_);
    topology.twin.resize(topology.origin.size());
    kind_.resize(topology.origin.size());
    make_positions();
    for (size_t k = 0; k < levels_.size(); ++k)
      for (uint32_t f = 0; f < fates_[k].face.size(); ++f)
        if (fates_[k].is_shown(f) && !fates_[k].is_divided(f)) make_faces(k, f);
    number_edges();
    if (!levels_[0].mesh.attributes.empty()) make_points();
    return std::move(out_);
  }

 private:
  /// Top down: what becomes of each face, and the vertices' numbers.
  void decide(size_t k) {
    const HierarchyLevel& level = levels_[k];
    const Topology& mesh = level.mesh.topology;
    Fate fate{.split = SplitPlan(level.split), .face = {}, .first = {}, .vertex = {}};
    fate.face.resize(mesh.face_count());
    fate.first.resize(mesh.face_count());
    fate.vertex.resize(mesh.vertex_count);
    fate.first_new_vertex = k == 0 ? mesh.vertex_count : fates_[k - 1].first_new_vertex + fates_[k - 1].split.count();
    for (uint32_t v = 0; v < mesh.vertex_count; ++v) fate.vertex[v] = k == 0 ? v : vertex_from_above(k, v);

    const bool has_children = k + 1 < levels_.size();
    for (uint32_t f = 0; f < mesh.face_count(); ++f) {
      if (k > 0 && !fates_[k - 1].is_divided(level.parent[f / 4])) {
        fate.face[f] = Fate::hidden;
        continue;
      }
      const unsigned mask = split_mask(mesh, fate.split, f);
      if (mask == 7 && has_children && level.child[f] != none) {
        fate.face[f] = Fate::divided;
        continue;
      }
      fate.face[f] = choose_transition(level, f, mask);
    }
    fates_.push_back(std::move(fate));
  }

  [[nodiscard]] uint32_t vertex_from_above(size_t k, uint32_t v) const {
    const Fate& above = fates_[k - 1];
    const uint32_t from = levels_[k].from[v];
    if (from < above.vertex.size()) return above.vertex[from];
    const uint32_t e = from - static_cast<uint32_t>(above.vertex.size());
    return above.split.is_split(e) ? above.first_new_vertex + above.split.before[e] : none;
  }

  /// Bottom up how many faces each gives, then top down where they lie.
  void place() {
    for (size_t k = levels_.size(); k-- > 0;) {
      Fate& fate = fates_[k];
      for (uint32_t f = 0; f < fate.face.size(); ++f) {
        if (!fate.is_shown(f)) continue;
        fate.first[f] = 0;
        if (!fate.is_divided(f))
          fate.first[f] = transition_pattern(fate.face[f]).children;
        else
          for (uint32_t c = 0; c < 4; ++c) fate.first[f] += fates_[k + 1].first[levels_[k].child[f] + c];
      }
    }
    for (uint32_t& first : fates_[0].first) face_count_ += std::exchange(first, face_count_);
    for (size_t k = 0; k + 1 < levels_.size(); ++k)
      for (uint32_t f = 0; f < fates_[k].face.size(); ++f) {
        if (!fates_[k].is_divided(f)) continue;
        uint32_t at = fates_[k].first[f];
        for (uint32_t c = 0; c < 4; ++c) {
          uint32_t& first = fates_[k + 1].first[levels_[k].child[f] + c];
          at += std::exchange(first, at);
        }
      }
  }

  void make_positions() {
    out_.positions.reserve(out_.topology.vertex_count);
    out_.positions = levels_[0].mesh.positions;
    for (size_t k = 0; k < levels_.size(); ++k)
      for (uint32_t e = 0; e < levels_[k].split.size(); ++e)
        if (fates_[k].split.is_split(e)) out_.positions.push_back(levels_[k].trial.at(e));
  }

  void make_faces(size_t k, uint32_t f) {
    const Topology& mesh = levels_[k].mesh.topology;
    const Fate& fate = fates_[k];
    const SplitPattern& cut = transition_pattern(fate.face[f]);
    const uint32_t base = 3 * fate.first[f];
    for (uint32_t c = 0; c < 3U * cut.children; ++c) {
      const uint8_t corner = cut.corner[c / 3][c % 3];
      out_.topology.origin[base + c] = corner < 3
                                           ? fate.vertex[mesh.origin[3 * f + corner]]
                                           : fate.first_new_vertex + fate.split.before[mesh.edge[3 * f + corner - 3U]];
      if (cut.inner_twin[c] != SplitPattern::outside) {
        out_.topology.twin[base + c] = base + cut.inner_twin[c];
        kind_[base + c] = EdgeKind::smooth;
      } else {
        const uint32_t h = 3 * f + cut.edge[c] / 2;
        out_.topology.twin[base + c] = twin_in_result(k, h, cut.edge[c] % 2);
        kind_[base + c] = kind_of(k, h);
      }
    }
  }

  /// Half-edge of the level above whose first or second half h is; h lies on the outside of its parent.
  [[nodiscard]] std::pair<uint32_t, uint32_t> half_of(size_t k, uint32_t h) const {
    const uint32_t f = Topology::face(h);
    const uint8_t half = split_pattern(7, false).edge[3 * (f % 4) + h % 3];
    return {3 * levels_[k].parent[f / 4] + half / 2U, half % 2U};
  }

  [[nodiscard]] EdgeKind kind_of(size_t k, uint32_t h) const {
    while (levels_[k].mesh.topology.kind[levels_[k].mesh.topology.edge[h]] == EdgeKind::cut) h = half_of(k--, h).first;
    return levels_[k].mesh.topology.kind[levels_[k].mesh.topology.edge[h]];
  }

  /// What runs against the first or second half (or the whole) of half-edge h of an undivided face.
  [[nodiscard]] uint32_t twin_in_result(size_t k, uint32_t h, uint32_t half) const {
    const Topology& mesh = levels_[k].mesh.topology;
    const uint32_t t = mesh.twin[h];
    if (t != none && fates_[k].is_shown(Topology::face(t)))
      return half_edge_in_result(k, t, fates_[k].split.is_split(mesh.edge[h]) ? 1 - half : 0);
    if (k == 0 || mesh.kind[mesh.edge[h]] == EdgeKind::boundary || mesh.kind[mesh.edge[h]] == EdgeKind::shared)
      return none;
    const auto [above, half_above] = half_of(k, h);
    return half_edge_in_result(k - 1, levels_[k - 1].mesh.topology.twin[above], 1 - half_above);
  }

  /// The half-edge of the result that is the first or second half (or the whole) of half-edge h of a shown face.
  [[nodiscard]] uint32_t half_edge_in_result(size_t k, uint32_t h, uint32_t half) const {
    while (fates_[k].is_divided(Topology::face(h))) {
      const uint8_t c = split_pattern(7, false).outer[2 * (h % 3) + half];
      h = 3 * levels_[k].child[Topology::face(h)] + c;
      half = 0;
      ++k;
    }
    const uint32_t f = Topology::face(h);
    return 3 * fates_[k].first[f] + transition_pattern(fates_[k].face[f]).outer[2 * (h % 3) + half];
  }

  void number_edges() {
    Topology& mesh = out_.topology;
    mesh.edge.resize(mesh.origin.size());
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> shared;
    for (uint32_t h = 0; h < mesh.half_edge_count(); ++h) {
      const uint32_t t = mesh.twin[h];
      if (t != none && t < h) {
        mesh.edge[h] = mesh.edge[t];
        continue;
      }
      if (kind_[h] == EdgeKind::shared) {
        const auto [known, is_new] =
            shared.try_emplace(std::minmax(mesh.origin[h], mesh.tip(h)), static_cast<uint32_t>(mesh.half_edge.size()));
        mesh.edge[h] = known->second;
        if (!is_new) continue;
      }
      mesh.edge[h] = mesh.edge_count();
      mesh.half_edge.push_back(h);
      mesh.kind.push_back(kind_[h]);
    }
  }

  /// Top down: the points of each shown face's corners.
  void make_points() {
    out_.attributes = levels_[0].mesh.attributes;
    std::vector<uint32_t> result(out_.topology.half_edge_count());
    for (size_t k = 0; k < levels_.size(); ++k) {
      const Topology& mesh = levels_[k].mesh.topology;
      const Fate& fate = fates_[k];
      const std::vector<uint32_t> made = split_points(mesh, fate.split, out_.attributes);
      const std::vector<uint32_t> corners = std::move(out_.attributes.point);
      const auto point = [&](uint32_t f, uint8_t corner) {
        return corner < 3 ? corners[3 * f + corner] : made[3 * f + corner - 3U];
      };
      out_.attributes.point.assign(k + 1 < levels_.size() ? levels_[k + 1].mesh.topology.half_edge_count() : 0, none);
      for (uint32_t f = 0; f < mesh.face_count(); ++f) {
        if (!fate.is_shown(f)) continue;
        const bool divided = fate.is_divided(f);
        const SplitPattern& cut = divided ? split_pattern(7, false) : transition_pattern(fate.face[f]);
        uint32_t* out =
            divided ? &out_.attributes.point[3 * size_t{levels_[k].child[f]}] : &result[3 * size_t{fate.first[f]}];
        for (uint32_t c = 0; c < 3U * cut.children; ++c) out[c] = point(f, cut.corner[c / 3][c % 3]);
      }
    }
    out_.attributes.point = std::move(result);
  }

  std::span<const HierarchyLevel> levels_;
  std::vector<Fate> fates_;
  uint32_t face_count_ = 0;
  Mesh out_;
  std::vector<EdgeKind> kind_;  ///< [H] of the result
};

/// [F] Which faces give way to their children in the result; `above` is the same of the level above.
std::vector<bool> find_divided(const HierarchyLevel& level, const SplitPlan& split, const std::vector<bool>& above) {
  const Topology& mesh = level.mesh.topology;
  std::vector<bool> divided(mesh.face_count());
  for (uint32_t f = 0; f < mesh.face_count(); ++f)
    divided[f] = (level.parent.empty() || above[level.parent[f / 4]]) && !level.child.empty() &&
                 level.child[f] != none && split_mask(mesh, split, f) == 7;
  return divided;
}

/// The two edges of the level below that half-edge h is split into; `none` where they are not held.
std::pair<uint32_t, uint32_t> halves(std::span<const HierarchyLevel> levels, size_t k, uint32_t h) {
  const uint32_t f = Topology::face(h);
  if (k + 1 == levels.size() || levels[k].child[f] == none) return {none, none};
  const auto half = [&](uint32_t i) {
    return levels[k + 1].mesh.topology.edge[3 * levels[k].child[f] + split_pattern(7, false).outer[2 * (h % 3) + i]];
  };
  return {half(0), half(1)};
}

}  // namespace

uint64_t count_assembled(std::span<const HierarchyLevel> levels) {
  // A split edge may only be one all of whose faces are in the result: each of them becomes one more.
  uint64_t faces = levels[0].mesh.topology.face_count();
  for (const HierarchyLevel& level : levels)
    for (uint32_t e : level.mesh.topology.edge) faces += level.split[e];
  return faces;
}

Mesh assemble(std::span<const HierarchyLevel> levels) { return Assembler(levels).run(); }

ErrorLeft error_left(std::span<const HierarchyLevel> levels, const Selection& selection) {
  ErrorLeft left(selection);
  std::vector<EdgeMarks> judged;
  std::vector<EdgeMarks> seen;
  for (const HierarchyLevel& level : levels) {
    judged.push_back(edges_of_candidates(level));
    seen.push_back(judged.back());
    selection.cull_unseen(level.mesh, level.trial.normals, seen.back());
  }
  std::vector<bool> above;
  for (size_t k = 0; k < levels.size(); ++k) {
    const HierarchyLevel& level = levels[k];
    const Topology& mesh = level.mesh.topology;
    const SplitPlan split = SplitPlan(level.split);
    const std::vector<bool> divided = find_divided(level, split, above);
    for (uint32_t h = 0; h < mesh.half_edge_count(); ++h) {
      const uint32_t f = Topology::face(h);
      const uint32_t e = mesh.edge[h];
      if (seen[k][e] == 0 || divided[f] || !(level.parent.empty() || above[level.parent[f / 4]])) continue;
      if (!split.is_split(e)) {
        left.add(level.mesh, e, level.trial.at(e));
        continue;
      }
      // Its halves may have been judged, though nothing below was wanted.
      const auto [first, second] = halves(levels, k, h);
      if (first == none || judged[k + 1][first] == 0 || judged[k + 1][second] == 0)
        left.add(level.mesh, e, level.trial.at(e), split_leaves);
      else
        for (uint32_t half : {first, second})
          if (seen[k + 1][half] != 0) left.add(levels[k + 1].mesh, half, levels[k + 1].trial.at(half));
    }
    above = divided;
  }
  return left;
}

}  // namespace papilio
