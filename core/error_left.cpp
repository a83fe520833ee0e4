#include "error_left.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "split_pattern.h"

namespace papilio {
namespace {

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
      find_reached(k);
      add_whole(k);
      if (k + 1 < levels_.size())
        add_split(k);
      else
        add_last_split(k);
    }
    return left_;
  }

 private:
  [[nodiscard]] const Topology& mesh_of(size_t k) const { return levels_[k].level->mesh.topology; }

  /// Finds the faces of the level's region above which all are divided.
  void find_reached(size_t k) {
    const LevelChoice& choice = levels_[k];
    if (k == 0) {
      reached_.assign(mesh_of(0).face_count(), 1);
      return;
    }
    List<uint8_t> below(mesh_of(k).face_count(), 0);
    for (size_t i = 0; i < choice.region.faces.size(); i += 4) {
      const uint32_t f = choice.region.faces[i];
      const uint32_t parent = choice.level->parent[f / 4];
      const uint8_t is_reached = levels_[k - 1].split_mask(parent) == 7 ? reached_[parent] : 0;
      std::fill_n(below.begin() + f, 4, is_reached);
    }
    reached_ = std::move(below);
  }

  /// Smaller deviations of the level are not the largest.
  [[nodiscard]] float surely_too_little(size_t k) const {
    constexpr double rounding = 1 - 1e-6;
    return static_cast<float>(rounding * left_.least_that_matters(scales_[k]));
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
    const Trial& trial = choice.level->trial;
    float too_little = surely_too_little(k);
    // Of a level that was kept most are known to be too little; of a new one nobody can guess which are split.
    List<uint32_t> edges;
    if (trial.planes.empty()) keep_if(edges = choice.region.edges, [&](uint32_t e) { return choice.split[e] == 0; });
    for (uint32_t e : trial.planes.empty() ? edges : choice.region.edges) {
      if (trial.no_less_than_deviation_at(e) < too_little || choice.split[e] != 0) continue;
      if (!may_matter(choice, e, scales_[k]) || is_near(k, e, 1)) continue;
      const uint32_t h = mesh.half_edge[e];
      const uint32_t t = mesh.twin[h];
      if (reached_[Topology::face(h)] == 0 && (t == none || reached_[Topology::face(t)] == 0)) continue;
      if (!choice.shown[e]) continue;
      add(k, e);
      too_little = surely_too_little(k);
    }
    for (uint32_t h : choice.level->shared) {
      const uint32_t e = mesh.edge[h];
      if (choice.may_be_split[e] != 0 && choice.split[e] == 0 && choice.shown[e] && reached_[Topology::face(h)] != 0)
        add(k, e);
    }
  }

  /// Of the last level nothing below was judged.
  void add_last_split(size_t k) {
    const LevelChoice& choice = levels_[k];
    for (uint32_t e : choice.split_edges) {
      if (!may_be_largest(k, e, split_leaves)) continue;
      if (is_near(k, e, split_leaves) || !choice.shown[e]) continue;
      add(k, e, split_leaves);
    }
  }

  void add_split(size_t k) {
    const LevelChoice& choice = levels_[k];
    for (uint32_t f : choice.faces_at_split()) {
      if (reached_[f] == 0) continue;
      const unsigned mask = choice.split_mask(f);
      const bool has_children = choice.has_children(f);
      if (has_children && mask == 7) continue;
      for (uint32_t i = 0; i < 3; ++i)
        if ((mask >> i & 1U) != 0) add_side(k, f, i, has_children);
    }
  }

  /// Side i of a face, which is split: its halves may have been judged, though nothing below was wanted.
  void add_side(size_t k, uint32_t f, uint32_t i, bool has_children) {
    const LevelChoice& choice = levels_[k];
    const uint32_t e = mesh_of(k).edge[3 * f + i];
    if (has_children) {
      const auto [first, second] = halves(k, f, i);
      const LevelChoice& below = levels_[k + 1];
      if (below.may_be_split[first] != 0 && below.may_be_split[second] != 0) {
        for (uint32_t half : {first, second})
          if (may_be_largest(k + 1, half) && choice.shown[e] && below.shown[half]) add(k + 1, half);
        return;
      }
    }
    if (may_be_largest(k, e, split_leaves) && choice.shown[e]) add(k, e, split_leaves);
  }

  /// By what is known of the deviation.
  [[nodiscard]] bool may_be_largest(size_t k, uint32_t e, double share = 1) const {
    return left_.may_grow_by(share * levels_[k].level->trial.no_less_than_deviation_at(e), scales_[k]);
  }

  /// The two edges of the level below that side i of a face is split into.
  [[nodiscard]] std::pair<uint32_t, uint32_t> halves(size_t k, uint32_t f, uint32_t i) const {
    const HierarchyLevel& below = *levels_[k + 1].level;
    const auto half = [&](uint32_t which) {
      return below.mesh.topology.edge[3 * below.child[f] + split_pattern(7, false).outer[2 * i + which]];
    };
    return {half(0), half(1)};
  }

  /// Whether the share of how far the edge's vertex is from the midpoint, which is on the surface, is too little to
  /// matter.
  [[nodiscard]] bool is_near(size_t k, uint32_t e, double share) const {
    const HierarchyLevel& level = *levels_[k].level;
    // Where more views are to come what was found serves them, too.
    if (!level.trial.planes.empty())
      return !left_.may_grow_by(share * level.trial.most_deviation_at(level.mesh, e), scales_[k]);
    const Vec3d off = share * (to_double(level.trial.at(e)) - midpoint(level.mesh, e));
    constexpr double rounding = 1 - 1e-6;
    const double least = left_.least_that_matters(scales_[k]);
    return dot(off, off) < rounding * least * least;
  }

  void add(size_t k, uint32_t e, double share = 1) {
    const HierarchyLevel& level = *levels_[k].level;
    left_.add(level.mesh, level.trial, scales_[k], e, share);
  }

  std::span<const LevelChoice> levels_;
  bool errors_are_pixels_;
  List<double> scales_;    ///< [level] the highest pixels per unit
  List<uint8_t> reached_;  ///< [F] of the level at hand: whether all faces above are divided
  ErrorLeft left_;
};

}  // namespace

ErrorLeft error_left(std::span<const LevelChoice> levels, const Selection& selection) {
  return ErrorFinder(levels, selection).run();
}

}  // namespace papilio
