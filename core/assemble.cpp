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

/// A level, and what becomes of its faces. Levels lie in an array: the one above is before, the one below behind.
struct AssembledLevel {
  static constexpr uint8_t hidden = 255;   ///< not in the result, nor its children
  static constexpr uint8_t divided = 254;  ///< its children are
  static constexpr uint8_t uncut = 0;      ///< the number of the pattern of no split edge

  const LevelChoice* choice;
  const HierarchyLevel* level;
  const Topology* mesh;
  uint32_t number;
  bool has_below;
  const uint32_t *origin, *twin, *edge;  ///< [H] of the mesh
  std::vector<uint8_t> fate;             ///< [F] hidden, divided, or the number of its pattern
  /// [F] the first half-edge of its faces in the result; written where these are there
  std::unique_ptr<uint32_t[]> first;
  std::unique_ptr<uint32_t[]> new_vertex;  ///< [E] number in the result of the edge's vertex; written where split
  std::vector<uint32_t> split_edges;       ///< in ascending order
  std::vector<uint32_t> shown;             ///< the faces that are not hidden, in ascending order; with attributes only

  [[nodiscard]] bool is_shown(uint32_t f) const { return fate[f] != hidden; }
  [[nodiscard]] bool is_divided(uint32_t f) const { return fate[f] == divided; }
  /// The first child of a divided face.
  [[nodiscard]] uint32_t child(uint32_t f) const { return this[1].level->child[f]; }
  /// The number in the result of a vertex of a face that is there.
  [[nodiscard]] uint32_t vertex_in_result(uint32_t v) const {
    for (const AssembledLevel* at = this; at->number > 0; --at) {
      const uint32_t from = at->level->from[v];
      const uint32_t above = at[-1].mesh->vertex_count;
      if (from >= above) return at[-1].new_vertex[from - above];
      v = from;
    }
    return v;
  }
};

class Assembler {
 public:
  Assembler(std::span<const LevelChoice> levels, double most_cosine, bool with_edges)
      : most_cosine_(most_cosine),
        with_edges_(with_edges),
        coarse_(levels[0].level->mesh),
        vertex_count_(coarse_.topology.vertex_count) {
    levels_.reserve(levels.size());
    for (const LevelChoice& choice : levels) add_level(choice, levels_.size() + 1 < levels.size());
    for (uint32_t f : levels[0].region.faces) place(levels_[0], f);
  }

  Mesh run() {
    Topology& topology = out_.topology;
    topology.vertex_count = vertex_count_;
    topology.pinched = coarse_.topology.pinched;
    topology.darts = coarse_.topology.darts;
    topology.origin.resize(half_edge_count_);
    topology.twin.assign(half_edge_count_, none);
    if (with_edges_) {
      topology.edge.resize(half_edge_count_);
      topology.half_edge.reserve(half_edge_count_ / 2 + vertex_count_ / 2);
      topology.kind.reserve(topology.half_edge.capacity());
    }
    make_positions();
    for (const Place& place : places_) make_faces(levels_[place.level], place.face);
    if (!coarse_.attributes.empty()) make_points();
    return std::move(out_);
  }

 private:
  /// A face of a level that is in the result, whole or cut.
  struct Place {
    uint32_t level;
    uint32_t face;
  };

  void add_level(const LevelChoice& choice, bool has_below) {
    const Topology& mesh = choice.level->mesh.topology;
    AssembledLevel& level = levels_.emplace_back();
    level.choice = &choice;
    level.level = choice.level.get();
    level.mesh = &mesh;
    level.number = static_cast<uint32_t>(levels_.size() - 1);
    level.has_below = has_below;
    level.origin = mesh.origin.data();
    level.twin = mesh.twin.data();
    level.edge = mesh.edge.data();
    level.fate.assign(mesh.face_count(), AssembledLevel::hidden);
    level.first = std::make_unique_for_overwrite<uint32_t[]>(mesh.face_count());
    level.new_vertex = std::make_unique_for_overwrite<uint32_t[]>(mesh.edge_count());
    level.split_edges = marked(choice.split);
    for (uint32_t e : level.split_edges) level.new_vertex[e] = vertex_count_++;
  }

  /// What becomes of a face and of what lies below it, and where that lies in the result.
  void place(AssembledLevel& level, uint32_t f) {
    if (!coarse_.attributes.empty()) level.shown.push_back(f);
    const unsigned mask = level.choice->split_mask(f);
    // What has children as support only is cut into the same four.
    if (mask == 7 && level.has_below && level.choice->red[f] != 0) {
      level.fate[f] = AssembledLevel::divided;
      for (uint32_t c = 0; c < 4; ++c) place((&level)[1], level.child(f) + c);
      return;
    }
    level.fate[f] = choose_transition(*level.level, f, mask, most_cosine_);
    level.first[f] = half_edge_count_;
    half_edge_count_ += 3U * transition_pattern(level.fate[f]).children;
    places_.push_back({level.number, f});
  }

  void make_positions() {
    out_.positions.reserve(vertex_count_);
    out_.positions = coarse_.positions;
    for (const AssembledLevel& level : levels_)
      for (uint32_t e : level.split_edges) out_.positions.push_back(level.level->trial.at(e));
  }

  /// In the order of the result: a half-edge whose twin was there before has its edge from it.
  void make_faces(const AssembledLevel& level, uint32_t f) {
    const SplitPattern& cut = transition_pattern(level.fate[f]);
    const uint32_t base = level.first[f];
    const uint32_t h = 3 * f;
    std::array<uint32_t, 6> vertex{};
    for (uint32_t i = 0; i < 3; ++i) vertex[i] = level.vertex_in_result(level.origin[h + i]);
    if (cut.children == 1) {
      for (uint32_t i = 0; i < 3; ++i) out_.topology.origin[base + i] = vertex[i];
      for (uint32_t i = 0; i < 3; ++i) {
        const uint32_t t = level.twin[h + i];
        if (!with_edges_ && t != none && level.fate[Topology::face(t)] == AssembledLevel::uncut)
          out_.topology.twin[base + i] = level.first[Topology::face(t)] + t % 3;
        else
          make_outer(base + i, level, h + i, 0);
      }
      return;
    }
    for (uint32_t i = 0; i < 3; ++i)
      if (level.choice->split[level.edge[h + i]] != 0) vertex[3 + i] = level.new_vertex[level.edge[h + i]];
    for (uint32_t c = 0; c < cut.children; ++c)
      for (uint32_t i = 0; i < 3; ++i) out_.topology.origin[base + 3 * c + i] = vertex[cut.corner[c][i]];
    for (uint32_t c = 0; c < 3U * cut.children; ++c) {
      if (cut.inner_twin[c] == SplitPattern::outside)
        make_outer(base + c, level, h + cut.edge[c] / 2, cut.edge[c] % 2);
      else
        make_edge(base + c, base + cut.inner_twin[c], EdgeKind::smooth);
    }
  }

  /// The edge and twin of a half-edge of the result, which is the first or second half (or the whole) of half-edge h.
  void make_outer(uint32_t made, const AssembledLevel& level, uint32_t h, uint32_t half) {
    if (out_.topology.twin[made] == none)
      make_new_edge(made, twin_in_result(level, h, half), level.mesh->kind[level.edge[h]]);
    else if (with_edges_)
      out_.topology.edge[made] = out_.topology.edge[out_.topology.twin[made]];
  }

  void make_edge(uint32_t made, uint32_t twin, EdgeKind kind) {
    if (out_.topology.twin[made] == none)
      make_new_edge(made, twin, kind);
    else if (with_edges_)
      out_.topology.edge[made] = out_.topology.edge[twin];
  }

  void make_new_edge(uint32_t made, uint32_t twin, EdgeKind kind) {
    Topology& mesh = out_.topology;
    if (twin != none) {
      mesh.twin[made] = twin;
      mesh.twin[twin] = made;
    }
    if (!with_edges_) return;
    mesh.edge[made] = mesh.edge_count();
    if (twin == none && kind == EdgeKind::shared) {
      const auto [known, is_new] = shared_.try_emplace(std::minmax(mesh.origin[made], mesh.tip(made)), mesh.edge[made]);
      mesh.edge[made] = known->second;
      if (!is_new) return;
    }
    mesh.half_edge.push_back(made);
    mesh.kind.push_back(kind);
  }

  /// What runs against the first or second half (or the whole) of half-edge h of an undivided face.
  [[nodiscard]] static uint32_t twin_in_result(const AssembledLevel& level, uint32_t h, uint32_t half) {
    const uint32_t t = level.twin[h];
    if (t != none && level.is_shown(Topology::face(t)))
      return half_edge_in_result(level, t, level.choice->split[level.edge[h]] != 0 ? 1 - half : 0);
    const EdgeKind kind = level.mesh->kind[level.edge[h]];
    if (level.number == 0 || kind == EdgeKind::boundary || kind == EdgeKind::shared) return none;
    // It lies on the outside of its parent, and is a half of one of that one's.
    const uint32_t f = Topology::face(h);
    const uint8_t outer = split_pattern(7, false).edge[3 * (f % 4) + h % 3];
    const AssembledLevel& above = (&level)[-1];
    return half_edge_in_result(above, above.twin[3 * level.level->parent[f / 4] + outer / 2U], 1 - outer % 2U);
  }

  /// The half-edge of the result that is the first or second half (or the whole) of half-edge h of a shown face.
  [[nodiscard]] static uint32_t half_edge_in_result(const AssembledLevel& level, uint32_t h, uint32_t half) {
    const AssembledLevel* at = &level;
    while (at->is_divided(Topology::face(h))) {
      h = 3 * at->child(Topology::face(h)) + split_pattern(7, false).outer[2 * (h % 3) + half];
      half = 0;
      ++at;
    }
    const uint32_t f = Topology::face(h);
    return at->first[f] + transition_pattern(at->fate[f]).outer[2 * (h % 3) + half];
  }

  /// Top down: the points of each shown face's corners.
  void make_points() {
    out_.attributes = coarse_.attributes;
    Array<uint32_t> result(half_edge_count_);
    for (const AssembledLevel& level : levels_) {
      const std::vector<uint32_t> made = split_points(*level.mesh, level.choice->split, level.shown, out_.attributes);
      const Array<uint32_t> corners = std::move(out_.attributes.point);
      const auto point = [&](uint32_t f, uint8_t corner) {
        return corner < 3 ? corners[3 * f + corner] : made[3 * f + corner - 3U];
      };
      out_.attributes.point.assign(level.has_below ? (&level)[1].mesh->half_edge_count() : 0, none);
      for (uint32_t f : level.shown) {
        const bool divided = level.is_divided(f);
        const SplitPattern& cut = divided ? split_pattern(7, false) : transition_pattern(level.fate[f]);
        uint32_t* out = divided ? &out_.attributes.point[3 * size_t{level.child(f)}] : &result[level.first[f]];
        for (uint32_t c = 0; c < 3U * cut.children; ++c) out[c] = point(f, cut.corner[c / 3][c % 3]);
      }
    }
    out_.attributes.point = std::move(result);
  }

  double most_cosine_;
  bool with_edges_;
  const Mesh& coarse_;
  std::vector<AssembledLevel> levels_;
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
  ErrorFinder(std::span<const LevelChoice> levels, const Selection& selection)
      : levels_(levels), errors_are_pixels_(selection.errors_are_pixels()), left_(selection) {
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

  /// Whether an edge that stays may have the largest deviation. The error of one that is wanted is often known better
  /// than what follows from the bound.
  [[nodiscard]] bool may_matter(const LevelChoice& choice, uint32_t e, double scale) const {
    constexpr double rounding = 1 + 1e-6;
    const double most = choice.level->trial.no_less_than_deviation_at(e);
    if (left_.may_grow_by_distance(most)) return true;
    if (!left_.may_grow_by_pixels(most * scale)) return false;
    return !errors_are_pixels_ || choice.error[e] < 0 || left_.may_grow_by_pixels(rounding * choice.error[e]);
  }

  void add_whole(size_t k) {
    const LevelChoice& choice = levels_[k];
    const Topology& mesh = mesh_of(k);
    for (uint32_t e : choice.region.edges) {
      if (choice.split[e] != 0 || !may_matter(choice, e, scales_[k]) || !choice.shown[e]) continue;
      const uint32_t h = mesh.half_edge[e];
      const uint32_t t = mesh.twin[h];
      if (is_reached(k, Topology::face(h)) || (t != none && is_reached(k, Topology::face(t)))) add(k, e);
    }
    for (uint32_t h : choice.level->shared) {
      const uint32_t e = mesh.edge[h];
      if (choice.may_be_split[e] != 0 && choice.split[e] == 0 && choice.shown[e] && is_reached(k, Topology::face(h)))
        add(k, e);
    }
  }

  void add_split(size_t k) {
    const LevelChoice& choice = levels_[k];
    const auto is_known = [&](uint32_t e) {
      return k + 1 == levels_.size() &&
             !left_.may_grow_by(split_leaves * choice.level->trial.no_less_than_deviation_at(e), scales_[k]);
    };
    choice.visit_faces_of_split([&](uint32_t f, uint32_t e) {
      if (is_known(e)) return;
      const bool has_children = choice.has_children(f);
      if (has_children && choice.split_mask(f) == 7) return;
      if (!choice.shown[e] || !is_reached(k, f)) return;
      // Its halves may have been judged, though nothing below was wanted.
      if (has_children && k + 1 < levels_.size()) {
        const auto [first, second] = halves(k, f, e);
        const LevelChoice& below = levels_[k + 1];
        if (below.may_be_split[first] != 0 && below.may_be_split[second] != 0) {
          for (uint32_t half : {first, second})
            if (below.shown[half]) add(k + 1, half);
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
  bool errors_are_pixels_;
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

Mesh assemble(std::span<const LevelChoice> levels, double most_cosine, bool with_edges) {
  return Assembler(levels, most_cosine, with_edges).run();
}

ErrorLeft error_left(std::span<const LevelChoice> levels, const Selection& selection) {
  return ErrorFinder(levels, selection).run();
}

}  // namespace papilio
