#include "assemble.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <utility>

#include "attributes.h"
#include "transition.h"

namespace papilio {
namespace {

/// What becomes of a level's faces.
struct Fate {
  static constexpr uint8_t hidden = 255;   ///< not in the result, nor its children
  static constexpr uint8_t divided = 254;  ///< its children are
  std::vector<uint8_t> face;               ///< [F] hidden, divided, or the number of its pattern
  /// [F] the first half-edge of its faces in the result; written where it is there itself only
  std::unique_ptr<uint32_t[]> first;
  std::unique_ptr<uint32_t[]> new_vertex;  ///< [E] number in the result of the edge's vertex; written where split only
  std::vector<uint32_t> split_edges;       ///< in ascending order
  std::vector<uint32_t> shown;             ///< the faces that are not hidden, in ascending order; with attributes only

  [[nodiscard]] bool is_shown(uint32_t f) const { return face[f] != hidden; }
  [[nodiscard]] bool is_divided(uint32_t f) const { return face[f] == divided; }
};

class Assembler {
 public:
  Assembler(std::span<const LevelChoice> levels, double most_cosine)
      : levels_(levels),
        most_cosine_(most_cosine),
        has_attributes_(!levels[0].level->mesh.attributes.empty()),
        vertex_count_(levels[0].level->mesh.topology.vertex_count) {
    for (size_t k = 0; k < levels.size(); ++k) number_vertices(k);
    for (uint32_t f : levels[0].region.faces) place(0, f);
  }

  Mesh run() {
    const Topology& coarse = mesh_of(0);
    Topology& topology = out_.topology;
    topology.vertex_count = vertex_count_;
    topology.pinched = coarse.pinched;
    topology.darts = coarse.darts;
    topology.origin.resize(half_edge_count_);
    topology.twin.assign(half_edge_count_, none);
    topology.edge.resize(half_edge_count_);
    topology.half_edge.reserve(half_edge_count_ / 2 + vertex_count_ / 2);
    topology.kind.reserve(topology.half_edge.capacity());
    make_positions();
    for (const Place& place : places_) make_faces(place.level, place.face);
    if (has_attributes_) make_points();
    return std::move(out_);
  }

 private:
  /// A face of a level that is in the result, whole or cut.
  struct Place {
    uint32_t level;
    uint32_t face;
  };

  [[nodiscard]] const Topology& mesh_of(size_t k) const { return levels_[k].level->mesh.topology; }

  void number_vertices(size_t k) {
    Fate fate;
    fate.face.assign(mesh_of(k).face_count(), Fate::hidden);
    fate.first = std::make_unique_for_overwrite<uint32_t[]>(mesh_of(k).face_count());
    fate.new_vertex = std::make_unique_for_overwrite<uint32_t[]>(mesh_of(k).edge_count());
    fate.split_edges = marked(levels_[k].split);
    for (uint32_t e : fate.split_edges) fate.new_vertex[e] = vertex_count_++;
    fates_.push_back(std::move(fate));
  }

  /// What becomes of a face and of what lies below it, and where that lies in the result.
  void place(uint32_t k, uint32_t f) {
    const LevelChoice& choice = levels_[k];
    Fate& fate = fates_[k];
    if (has_attributes_) fate.shown.push_back(f);
    const unsigned mask = choice.split_mask(f);
    // What has children as support only is cut into the same four.
    if (mask == 7 && k + 1 < levels_.size() && choice.red[f] != 0) {
      fate.face[f] = Fate::divided;
      for (uint32_t c = 0; c < 4; ++c) place(k + 1, child(k, f) + c);
      return;
    }
    fate.face[f] = choose_transition(*choice.level, f, mask, most_cosine_);
    fate.first[f] = half_edge_count_;
    half_edge_count_ += 3U * transition_pattern(fate.face[f]).children;
    places_.push_back({k, f});
  }

  /// The first child of a divided face.
  [[nodiscard]] uint32_t child(size_t k, uint32_t f) const { return levels_[k + 1].level->child[f]; }

  void make_positions() {
    out_.positions.reserve(vertex_count_);
    out_.positions = levels_[0].level->mesh.positions;
    for (size_t k = 0; k < levels_.size(); ++k)
      for (uint32_t e : fates_[k].split_edges) out_.positions.push_back(levels_[k].level->trial.at(e));
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

  /// In the order of the result: a half-edge whose twin was there before has its edge from it.
  void make_faces(size_t k, uint32_t f) {
    const Topology& mesh = mesh_of(k);
    const Fate& fate = fates_[k];
    const SplitPattern& cut = transition_pattern(fate.face[f]);
    const uint32_t count = 3U * cut.children;
    const uint32_t base = fate.first[f];
    std::array<uint32_t, 6> vertex{};
    for (uint32_t i = 0; i < 3; ++i) {
      vertex[i] = vertex_in_result(k, mesh.origin[3 * f + i]);
      if (levels_[k].split[mesh.edge[3 * f + i]] != 0) vertex[3 + i] = fate.new_vertex[mesh.edge[3 * f + i]];
    }
    for (uint32_t c = 0; c < count; ++c) out_.topology.origin[base + c] = vertex[cut.corner[c / 3][c % 3]];
    for (uint32_t c = 0; c < count; ++c) {
      const uint32_t known = out_.topology.twin[base + c];
      if (known != none) {
        out_.topology.edge[base + c] = out_.topology.edge[known];
      } else if (cut.inner_twin[c] != SplitPattern::outside) {
        make_edge(base + c, base + cut.inner_twin[c], EdgeKind::smooth);
      } else {
        const uint32_t h = 3 * f + cut.edge[c] / 2;
        make_edge(base + c, twin_in_result(k, h, cut.edge[c] % 2), mesh.kind[mesh.edge[h]]);
      }
    }
  }

  void make_edge(uint32_t h, uint32_t twin, EdgeKind kind) {
    Topology& mesh = out_.topology;
    mesh.edge[h] = mesh.edge_count();
    if (twin != none) {
      mesh.twin[h] = twin;
      mesh.twin[twin] = h;
    } else if (kind == EdgeKind::shared) {
      const auto [known, is_new] = shared_.try_emplace(std::minmax(mesh.origin[h], mesh.tip(h)), mesh.edge[h]);
      mesh.edge[h] = known->second;
      if (!is_new) return;
    }
    mesh.half_edge.push_back(h);
    mesh.kind.push_back(kind);
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
    return fates_[k].first[f] + transition_pattern(fates_[k].face[f]).outer[2 * (h % 3) + half];
  }

  /// Top down: the points of each shown face's corners.
  void make_points() {
    out_.attributes = levels_[0].level->mesh.attributes;
    std::vector<uint32_t> result(out_.topology.half_edge_count());
    for (size_t k = 0; k < levels_.size(); ++k) {
      const Fate& fate = fates_[k];
      const std::vector<uint32_t> made = split_points(mesh_of(k), levels_[k].split, fate.shown, out_.attributes);
      const std::vector<uint32_t> corners = std::move(out_.attributes.point);
      const auto point = [&](uint32_t f, uint8_t corner) {
        return corner < 3 ? corners[3 * f + corner] : made[3 * f + corner - 3U];
      };
      out_.attributes.point.assign(k + 1 < levels_.size() ? mesh_of(k + 1).half_edge_count() : 0, none);
      for (uint32_t f : fate.shown) {
        const bool divided = fate.is_divided(f);
        const SplitPattern& cut = divided ? split_pattern(7, false) : transition_pattern(fate.face[f]);
        uint32_t* out = divided ? &out_.attributes.point[3 * size_t{child(k, f)}] : &result[fate.first[f]];
        for (uint32_t c = 0; c < 3U * cut.children; ++c) out[c] = point(f, cut.corner[c / 3][c % 3]);
      }
    }
    out_.attributes.point = std::move(result);
  }

  std::span<const LevelChoice> levels_;
  double most_cosine_;
  bool has_attributes_;
  std::vector<Fate> fates_;
  std::vector<Place> places_;  ///< in the order of the result
  uint32_t half_edge_count_ = 0;
  uint32_t vertex_count_;
  Mesh out_;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> shared_;  ///< edge of the result between two vertices
};

/// Finds the largest deviation left at the edges of the faces that are not divided. Edges are looked at in their
/// level's order; which of them count is asked only of those that may matter.
class ErrorFinder {
 public:
  ErrorFinder(std::span<const LevelChoice> levels, const Selection& selection) : levels_(levels), left_(selection) {
    for (const LevelChoice& choice : levels) scales_.push_back(selection.highest_pixels_per_unit(choice.level->box));
  }

  ErrorLeft run() {
    for (size_t k = 0; k < levels_.size(); ++k) {
      add_whole(k);
      add_split(k);
    }
    return left_;
  }

 private:
  [[nodiscard]] const Topology& mesh_of(size_t k) const { return levels_[k].level->mesh.topology; }

  /// Whether all faces above one of the region are divided.
  [[nodiscard]] bool is_reached(size_t k, uint32_t f) const {
    for (; k > 0; --k) {
      f = levels_[k].level->parent[f / 4];
      if (levels_[k - 1].split_mask(f) != 7) return false;
    }
    return true;
  }

  void add_whole(size_t k) {
    const LevelChoice& choice = levels_[k];
    const Topology& mesh = mesh_of(k);
    const Trial& trial = choice.level->trial;
    const auto is_whole = [&](uint32_t e) { return choice.shown[e] != 0 && choice.split[e] == 0; };
    for (uint32_t e : choice.region.edges) {
      if (!is_whole(e) || !left_.may_grow_by(trial.no_less_than_deviation_at(e), scales_[k])) continue;
      const uint32_t h = mesh.half_edge[e];
      const uint32_t t = mesh.twin[h];
      if (is_reached(k, Topology::face(h)) || (t != none && is_reached(k, Topology::face(t)))) add(k, e);
    }
    for (uint32_t h : choice.level->shared)
      if (is_whole(mesh.edge[h]) && is_reached(k, Topology::face(h))) add(k, mesh.edge[h]);
  }

  void add_split(size_t k) {
    const LevelChoice& choice = levels_[k];
    const auto is_known = [&](uint32_t e) {
      return k + 1 == levels_.size() &&
             !left_.may_grow_by(split_leaves * choice.level->trial.no_less_than_deviation_at(e), scales_[k]);
    };
    choice.visit_faces_of_split([&](uint32_t f, uint32_t e) {
      if (choice.shown[e] == 0 || is_known(e) || !is_reached(k, f)) return;
      const bool has_children = choice.has_children(f);
      if (has_children && choice.split_mask(f) == 7) return;
      // Its halves may have been judged, though nothing below was wanted.
      if (has_children && k + 1 < levels_.size()) {
        const auto [first, second] = halves(k, f, e);
        const LevelChoice& below = levels_[k + 1];
        if (below.may_be_split[first] != 0 && below.may_be_split[second] != 0) {
          for (uint32_t half : {first, second})
            if (below.shown[half] != 0) add(k + 1, half);
          return;
        }
      }
      add(k, e, split_leaves);
    });
  }

  /// The two edges of the level below that a face's edge is split into.
  [[nodiscard]] std::pair<uint32_t, uint32_t> halves(size_t k, uint32_t f, uint32_t e) const {
    const uint32_t* edge = &mesh_of(k).edge[size_t{3} * f];
    const uint32_t i = edge[0] == e ? 0 : edge[1] == e ? 1 : 2;
    const HierarchyLevel& below = *levels_[k + 1].level;
    const auto half = [&](uint32_t which) {
      return below.mesh.topology.edge[3 * below.child[f] + split_pattern(7, false).outer[2 * i + which]];
    };
    return {half(0), half(1)};
  }

  void add(size_t k, uint32_t e, double share = 1) {
    const HierarchyLevel& level = *levels_[k].level;
    left_.add(level.mesh, level.trial, scales_[k], e, share);
  }

  std::span<const LevelChoice> levels_;
  std::vector<double> scales_;  ///< [level] the highest pixels per unit
  ErrorLeft left_;
};

}  // namespace

uint64_t count_assembled(std::span<const LevelChoice> levels) {
  // A split edge may only be one all of whose faces are in the result: each of them becomes one more.
  uint64_t faces = levels[0].region.faces.size();
  for (const LevelChoice& choice : levels) choice.visit_faces_of_split([&](uint32_t, uint32_t) { ++faces; });
  return faces;
}

Mesh assemble(std::span<const LevelChoice> levels, double most_cosine) { return Assembler(levels, most_cosine).run(); }

ErrorLeft error_left(std::span<const LevelChoice> levels, const Selection& selection) {
  return ErrorFinder(levels, selection).run();
}

}  // namespace papilio
