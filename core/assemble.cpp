#include "assemble.h"

#include <algorithm>
#include <array>
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
  std::vector<uint32_t> shown;             ///< the faces that are not hidden, in ascending order
  std::vector<uint8_t> face;               ///< [F] hidden, divided, or the number of its pattern
  std::vector<uint32_t> first;             ///< [F] where its faces begin in the result; meaningless where hidden
  std::vector<uint32_t> new_vertex;        ///< [E] number in the result of the edge's vertex; meaningless where whole

  [[nodiscard]] bool is_shown(uint32_t f) const { return face[f] != hidden; }
  [[nodiscard]] bool is_divided(uint32_t f) const { return face[f] == divided; }
};

class Assembler {
 public:
  Assembler(std::span<const LevelChoice> levels, double most_cosine)
      : levels_(levels), most_cosine_(most_cosine), vertex_count_(levels[0].level->mesh.topology.vertex_count) {
    for (size_t k = 0; k < levels.size(); ++k) decide(k);
    place();
  }

  Mesh run() {
    const Topology& coarse = mesh_of(0);
    Topology& topology = out_.topology;
    topology.vertex_count = vertex_count_;
    topology.pinched = coarse.pinched;
    topology.darts = coarse.darts;
    topology.origin.resize(size_t{3} * face_count_);
    topology.twin.resize(topology.origin.size());
    kind_.resize(topology.origin.size());
    make_positions();
    for (size_t k = 0; k < levels_.size(); ++k)
      for (uint32_t f : fates_[k].shown)
        if (!fates_[k].is_divided(f)) make_faces(k, f);
    number_edges();
    if (!levels_[0].level->mesh.attributes.empty()) make_points();
    return std::move(out_);
  }

 private:
  [[nodiscard]] const Topology& mesh_of(size_t k) const { return levels_[k].level->mesh.topology; }

  /// Top down: what becomes of each face, and the numbers of the vertices on split edges.
  void decide(size_t k) {
    const LevelChoice& choice = levels_[k];
    Fate fate;
    fate.face.assign(mesh_of(k).face_count(), Fate::hidden);
    fate.first.resize(mesh_of(k).face_count());
    fate.new_vertex.resize(mesh_of(k).edge_count());
    for (uint32_t e : choice.region.edges)
      if (choice.split[e] != 0) fate.new_vertex[e] = vertex_count_++;
    for (uint32_t f : choice.region.faces) {
      if (k > 0 && !fates_[k - 1].is_divided(choice.level->parent[f / 4])) continue;
      const unsigned mask = choice.split_mask(f);
      // What has children as support only is cut into the same four.
      const bool divided = mask == 7 && k + 1 < levels_.size() && choice.red[f] != 0;
      fate.face[f] = divided ? Fate::divided : choose_transition(*choice.level, f, mask, most_cosine_);
      fate.shown.push_back(f);
    }
    fates_.push_back(std::move(fate));
  }

  /// Bottom up how many faces each gives, then top down where they lie.
  void place() {
    for (size_t k = levels_.size(); k-- > 0;) {
      Fate& fate = fates_[k];
      for (uint32_t f : fate.shown) {
        fate.first[f] = 0;
        if (!fate.is_divided(f))
          fate.first[f] = transition_pattern(fate.face[f]).children;
        else
          for (uint32_t c = 0; c < 4; ++c) fate.first[f] += fates_[k + 1].first[child(k, f) + c];
      }
    }
    for (uint32_t& first : fates_[0].first) face_count_ += std::exchange(first, face_count_);
    for (size_t k = 0; k + 1 < levels_.size(); ++k)
      for (uint32_t f : fates_[k].shown) {
        if (!fates_[k].is_divided(f)) continue;
        uint32_t at = fates_[k].first[f];
        for (uint32_t c = 0; c < 4; ++c) {
          uint32_t& first = fates_[k + 1].first[child(k, f) + c];
          at += std::exchange(first, at);
        }
      }
  }

  /// The first child of a divided face.
  [[nodiscard]] uint32_t child(size_t k, uint32_t f) const { return levels_[k + 1].level->child[f]; }

  void make_positions() {
    out_.positions.reserve(vertex_count_);
    out_.positions = levels_[0].level->mesh.positions;
    for (const LevelChoice& choice : levels_)
      for (uint32_t e : choice.region.edges)
        if (choice.split[e] != 0) out_.positions.push_back(choice.level->trial.at(e));
  }

  /// The number in the result of vertex v of a level.
  [[nodiscard]] uint32_t vertex_in_result(size_t k, uint32_t v) const {
    for (; k > 0; --k) {
      const uint32_t from = levels_[k].level->from[v];
      const uint32_t above = mesh_of(k - 1).vertex_count;
      if (from >= above) return fates_[k - 1].new_vertex[from - above];
      v = from;
    }
    return v;
  }

  void make_faces(size_t k, uint32_t f) {
    const Topology& mesh = mesh_of(k);
    const Fate& fate = fates_[k];
    const SplitPattern& cut = transition_pattern(fate.face[f]);
    const uint32_t base = 3 * fate.first[f];
    std::array<uint32_t, 6> vertex{};
    for (uint32_t i = 0; i < 3; ++i) {
      vertex[i] = vertex_in_result(k, mesh.origin[3 * f + i]);
      vertex[3 + i] = fate.new_vertex[mesh.edge[3 * f + i]];
    }
    for (uint32_t c = 0; c < 3U * cut.children; ++c) {
      out_.topology.origin[base + c] = vertex[cut.corner[c / 3][c % 3]];
      if (cut.inner_twin[c] != SplitPattern::outside) {
        out_.topology.twin[base + c] = base + cut.inner_twin[c];
        kind_[base + c] = EdgeKind::smooth;
      } else {
        const uint32_t h = 3 * f + cut.edge[c] / 2;
        out_.topology.twin[base + c] = twin_in_result(k, h, cut.edge[c] % 2);
        kind_[base + c] = mesh.kind[mesh.edge[h]];
      }
    }
  }

  /// Half-edge of the level above whose first or second half h is; h lies on the outside of its parent.
  [[nodiscard]] std::pair<uint32_t, uint32_t> half_of(size_t k, uint32_t h) const {
    const uint32_t f = Topology::face(h);
    const uint8_t half = split_pattern(7, false).edge[3 * (f % 4) + h % 3];
    return {3 * levels_[k].level->parent[f / 4] + half / 2U, half % 2U};
  }

  /// What runs against the first or second half (or the whole) of half-edge h of an undivided face.
  [[nodiscard]] uint32_t twin_in_result(size_t k, uint32_t h, uint32_t half) const {
    const Topology& mesh = mesh_of(k);
    const uint32_t t = mesh.twin[h];
    if (t != none && fates_[k].is_shown(Topology::face(t)))
      return half_edge_in_result(k, t, levels_[k].split[mesh.edge[h]] != 0 ? 1 - half : 0);
    if (k == 0 || mesh.kind[mesh.edge[h]] == EdgeKind::boundary || mesh.kind[mesh.edge[h]] == EdgeKind::shared)
      return none;
    const auto [above, half_above] = half_of(k, h);
    return half_edge_in_result(k - 1, mesh_of(k - 1).twin[above], 1 - half_above);
  }

  /// The half-edge of the result that is the first or second half (or the whole) of half-edge h of a shown face.
  [[nodiscard]] uint32_t half_edge_in_result(size_t k, uint32_t h, uint32_t half) const {
    while (fates_[k].is_divided(Topology::face(h))) {
      const uint8_t c = split_pattern(7, false).outer[2 * (h % 3) + half];
      h = 3 * child(k, Topology::face(h)) + c;
      half = 0;
      ++k;
    }
    const uint32_t f = Topology::face(h);
    return 3 * fates_[k].first[f] + transition_pattern(fates_[k].face[f]).outer[2 * (h % 3) + half];
  }

  void number_edges() {
    Topology& mesh = out_.topology;
    mesh.edge.resize(mesh.origin.size());
    mesh.half_edge.reserve(mesh.origin.size() / 2 + vertex_count_ / 2);
    mesh.kind.reserve(mesh.half_edge.capacity());
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
    out_.attributes = levels_[0].level->mesh.attributes;
    Array<uint32_t> result(out_.topology.half_edge_count());
    for (size_t k = 0; k < levels_.size(); ++k) {
      const Fate& fate = fates_[k];
      const std::vector<uint32_t> made = split_points(mesh_of(k), levels_[k].split, fate.shown, out_.attributes);
      const Array<uint32_t> corners = std::move(out_.attributes.point);
      const auto point = [&](uint32_t f, uint8_t corner) {
        return corner < 3 ? corners[3 * f + corner] : made[3 * f + corner - 3U];
      };
      out_.attributes.point.assign(k + 1 < levels_.size() ? mesh_of(k + 1).half_edge_count() : 0, none);
      for (uint32_t f : fate.shown) {
        const bool divided = fate.is_divided(f);
        const SplitPattern& cut = divided ? split_pattern(7, false) : transition_pattern(fate.face[f]);
        uint32_t* out = divided ? &out_.attributes.point[3 * size_t{child(k, f)}] : &result[3 * size_t{fate.first[f]}];
        for (uint32_t c = 0; c < 3U * cut.children; ++c) out[c] = point(f, cut.corner[c / 3][c % 3]);
      }
    }
    out_.attributes.point = std::move(result);
  }

  std::span<const LevelChoice> levels_;
  double most_cosine_;
  std::vector<Fate> fates_;
  uint32_t face_count_ = 0;
  uint32_t vertex_count_;
  Mesh out_;
  std::vector<EdgeKind> kind_;  ///< [H] of the result
};

/// [F] Which faces of the region give way to their children in the result; `above` is the same of the level above.
std::vector<uint8_t> find_divided(const LevelChoice& choice, const std::vector<uint8_t>& above) {
  std::vector<uint8_t> divided(choice.level->mesh.topology.face_count(), 0);
  for (uint32_t f : choice.region.faces)
    if ((above.empty() || above[choice.level->parent[f / 4]] != 0) && choice.split_mask(f) == 7 &&
        choice.has_children(f))
      divided[f] = 1;
  return divided;
}

/// The two edges of the level below that half-edge h is split into; `none` where this request has none there.
std::pair<uint32_t, uint32_t> halves(std::span<const LevelChoice> levels, size_t k, uint32_t h) {
  const uint32_t f = Topology::face(h);
  if (k + 1 == levels.size() || !levels[k].has_children(f)) return {none, none};
  const HierarchyLevel& below = *levels[k + 1].level;
  const auto half = [&](uint32_t i) {
    return below.mesh.topology.edge[3 * below.child[f] + split_pattern(7, false).outer[2 * (h % 3) + i]];
  };
  return {half(0), half(1)};
}

}  // namespace

uint64_t count_assembled(std::span<const LevelChoice> levels) {
  // A split edge may only be one all of whose faces are in the result: each of them becomes one more.
  uint64_t faces = levels[0].region.faces.size();
  for (const LevelChoice& choice : levels) choice.visit_faces_of_split([&](uint32_t, uint32_t) { ++faces; });
  return faces;
}

Mesh assemble(std::span<const LevelChoice> levels, double most_cosine) { return Assembler(levels, most_cosine).run(); }

ErrorLeft error_left(std::span<const LevelChoice> levels, const Selection& selection) {
  ErrorLeft left(selection);
  std::vector<double> scales;
  for (const LevelChoice& choice : levels) scales.push_back(selection.highest_pixels_per_unit(choice.level->box));
  std::vector<uint8_t> above;
  for (size_t k = 0; k < levels.size(); ++k) {
    const LevelChoice& choice = levels[k];
    const HierarchyLevel& level = *choice.level;
    const std::vector<uint8_t> divided = find_divided(choice, above);
    std::vector<uint8_t> was_added(level.mesh.topology.edge_count(), 0);
    const auto add = [&](uint32_t h) {
      const uint32_t e = level.mesh.topology.edge[h];
      if (choice.shown[e] == 0) return;
      if (choice.split[e] == 0) {
        if (std::exchange(was_added[e], 1) != 0) return;
        left.add(level.mesh, level.trial, scales[k], e);
        return;
      }
      // Its halves may have been judged, though nothing below was wanted.
      const auto [first, second] = halves(levels, k, h);
      if (first == none || levels[k + 1].may_be_split[first] == 0 || levels[k + 1].may_be_split[second] == 0) {
        left.add(level.mesh, level.trial, scales[k], e, split_leaves);
        return;
      }
      const HierarchyLevel& below = *levels[k + 1].level;
      for (uint32_t half : {first, second})
        if (levels[k + 1].shown[half] != 0) left.add(below.mesh, below.trial, scales[k + 1], half);
    };
    for (uint32_t f : choice.region.faces)
      if (divided[f] == 0 && (k == 0 || above[level.parent[f / 4]] != 0))
        for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) add(h);
    above = divided;
  }
  return left;
}

}  // namespace papilio
