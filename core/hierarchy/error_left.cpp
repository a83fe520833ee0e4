#include "hierarchy/error_left.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "criteria/deviation_cutoff.h"
#include "mesh/four_children.h"
#include "simd/vec3fa.h"
#include "split/split_pattern.h"

namespace papilio {
namespace {

/// Search for the largest deviation left at the edges of undivided faces. Of an unsplit edge all of its deviation is
/// left. Of a split side those of its halves are left if they were judged, or else a share of its own; likewise of
/// split edges of the last level. Visits edges in their level's order. Whether an edge counts is tested only if its
/// deviation may be the largest.
class ErrorFinder {
 public:
  ErrorFinder(std::span<const LevelChoice> levels, const Selection& selection) : levels_(levels), left_(selection) {
    for (const LevelChoice& choice : levels) scales_.push_back(selection.highest_pixels_per_unit(choice.level->box));
  }

  ErrorLeft run() {
    for (size_t k = 0; k < levels_.size(); ++k) {
      find_reached(k);
      add_unsplit(k);
      if (is_last(k))
        add_last_split(k);
      else
        add_split(k);
    }
    return left_;
  }

 private:
  /// Returns the share of a deviation of level k that is left where its edge is split: 0 on the last level of detail,
  /// whose vertices lie on the surface.
  [[nodiscard]] double split_share(size_t k) const { return levels_[k].level->detail_levels == 1 ? 0 : split_leaves; }
  [[nodiscard]] bool is_last(size_t k) const { return k + 1 == levels_.size(); }
  [[nodiscard]] const Topology& mesh_of(size_t k) const { return levels_[k].level->mesh.topology; }

  /// Finds the faces of the level's region whose ancestors are all divided.
  void find_reached(size_t k) {
    const LevelChoice& choice = levels_[k];
    if (k == 0) {
      reached_.assign(mesh_of(0).face_count(), 1);
      return;
    }
    Buffer<uint8_t> below(mesh_of(k).face_count(), 0);
    for (size_t i = 0; i < choice.region.faces.size(); i += 4) {
      const FaceId f = choice.region.faces[i];
      const uint32_t parent = choice.level->parent_of(f);
      const uint8_t is_reached = levels_[k - 1].split_mask(parent) == 7 ? reached_[parent] : 0;
      std::fill_n(below.begin() + f, 4, is_reached);
    }
    reached_ = std::move(below);
  }

  /// Returns a lower bound of the largest deviation, for edges of level k.
  [[nodiscard]] float cutoff(size_t k) const {
    constexpr double rounding = 1 - 1e-6;
    return static_cast<float>(rounding * left_.least_that_matters(scales_[k]));
  }

  /// Returns whether an unsplit edge may have the largest deviation. Its error in the choice is no bound: it may come
  /// from an edge of a level below.
  [[nodiscard]] bool may_matter(const HierarchyLevel& level, EdgeId e, double scale) const {
    const double most = level.trial.stored_deviation_bound(e);
    return left_.may_grow_by(most, scale) && left_.may_grow_at(level.mesh, e, most);
  }

  void add_unsplit(size_t k) {
    const LevelChoice& choice = levels_[k];
    const Topology& mesh = mesh_of(k);
    const Trial& trial = choice.level->trial;
    if (trial.bounds.empty()) {
      add_beyond_cutoff(k);
    } else {
      float least = cutoff(k);
      // Branch-free on a new level, where splits are unpredictable. On a kept level, most edges are below the cutoff.
      Buffer<uint32_t> edges = choice.region.edges();
      if (!trial.is_kept) keep_if(edges, [&](EdgeId e) { return choice.split[e] == 0; });
      for (EdgeId e : edges) {
        if (trial.stored_deviation_bound(e) < least || choice.split[e] != 0) continue;
        if (!may_matter(*choice.level, e, scales_[k]) || is_near(k, e, 1)) continue;
        add_unsplit(k, e);
        least = cutoff(k);
      }
    }
    for (HalfEdgeId h : choice.level->shared) {
      const EdgeId e = mesh.edge[h];
      if (choice.region.has_edge[e] != 0 && choice.split[e] == 0 && choice.shown[e] && reached_[h.face()] != 0)
        add(k, e);
    }
  }

  /// Adds an unsplit edge of the region.
  void add_unsplit(size_t k, EdgeId e) {
    const Topology& mesh = mesh_of(k);
    const HalfEdgeId h = mesh.half_edge[e];
    const HalfEdgeId t = mesh.twin[h];
    if (reached_[h.face()] == 0 && (t == none || reached_[t.face()] == 0)) return;
    if (levels_[k].shown[e]) add(k, e);
  }

  /// Adds the region's unsplit edges, and on the last level its split ones, where the level has no bounds of
  /// deviations. Skips edges whose new vertex is too near the middle.
  void add_beyond_cutoff(size_t k) {
    const LevelChoice& choice = levels_[k];
    const Mesh& mesh = choice.level->mesh;
    const Vec3f* const positions = mesh.positions.data();
    const Vec3f* const made = choice.level->trial.made.data();
    const uint8_t* const may_be_split = choice.region.has_edge.data();
    const uint8_t* const is_split = choice.split.data();
    const auto split_squared = static_cast<float>(is_last(k) ? split_share(k) * split_share(k) : 0);
    const std::array<float, 2> share_squared{1, split_squared};  // [is split]
    DeviationCutoff too_near(choice.level->box.largest_coordinate());
    const auto raise = [&] { too_near.raise(left_.least_that_matters(scales_[k])); };
    raise();
    const auto look_at = [&](EdgeId e, Vec3fa from, Vec3fa to) __attribute__((always_inline)) {
      const float squared = share_squared[is_split[e]] * squared_length(widen(made[e]) - 0.5F * (from + to));
      if (squared <= too_near.squared() || may_be_split[e] == 0 || !choice.shown[e]) [[likely]]
        return;
      add_beyond_cutoff(k, e);
      raise();
    };
    if (k == 0) {
      for (EdgeId e = 0; e < mesh.topology.edge_count(); ++e) {
        const HalfEdgeId h = mesh.topology.half_edge[e];
        look_at(e, widen(positions[mesh.topology.origin[h]]), widen(positions[mesh.topology.tip(h)]));
      }
      return;
    }
    for (size_t i = 0; i < choice.region.faces.size(); i += 4) {
      const FaceId f = choice.region.faces[i];
      if (reached_[f] == 0 || are_all_divided(choice, f)) continue;
      const uint32_t* edge = &mesh.topology.edge[size_t{3} * f];
      const std::array<uint32_t, 6> vertex = vertices_of_four(&mesh.topology.origin[size_t{3} * f]);
      std::array<Vec3fa, 6> at;
      for (uint32_t c = 0; c < 6; ++c) at[c] = widen(positions[vertex[c]]);
      visit_edges_of_four([&](uint32_t half_edge, uint32_t from, uint32_t to)
                              __attribute__((always_inline)) { look_at(edge[half_edge], at[from], at[to]); });
    }
  }
  [[gnu::noinline]] void add_beyond_cutoff(size_t k, EdgeId e) {
    if (levels_[k].split[e] == 0)
      add_unsplit(k, e);
    else if (is_last(k))
      add_last_split(k, e);
  }
  /// Returns whether all four children of a face are divided, so that the result has none of their edges.
  [[nodiscard]] static bool are_all_divided(const LevelChoice& choice, uint32_t child) {
    if (choice.red.empty()) return false;
    unsigned mask = 7;
    for (uint32_t c = child; c < child + 4; ++c) mask &= choice.red[c] != 0 ? choice.split_mask(c) : 0;
    return mask == 7;
  }

  /// Adds split edges of the last level, below which no edge was judged.
  void add_last_split(size_t k) {
    const LevelChoice& choice = levels_[k];
    if (choice.level->trial.bounds.empty()) return;  // add_beyond_cutoff did it
    for (EdgeId e : choice.split_edges)
      if (may_be_largest(k, e, split_share(k)) && !is_near(k, e, split_share(k))) add_last_split(k, e);
  }
  void add_last_split(size_t k, EdgeId e) {
    if (levels_[k].shown[e]) add(k, e, split_share(k));
  }

  /// Adds the split sides of faces that are cut in two or three, or in four without an explored level below.
  void add_split(size_t k) {
    const LevelChoice& choice = levels_[k];
    const Buffer<uint32_t> faces = chosen(choice.region.faces, [&](FaceId f) {
      const unsigned mask = choice.split_mask(f);
      return mask != 0 && reached_[f] != 0 && (mask != 7 || !are_children_judged(k, f));
    });
    Buffer<uint32_t> sides(3 * faces.size());
    for (size_t i = 0; i < faces.size(); ++i)
      for (uint32_t c = 0; c < 3; ++c) sides[3 * i + c] = 3 * faces[i] + c;
    const Topology& mesh = mesh_of(k);
    keep_if(sides, [&](HalfEdgeId h) { return choice.split[mesh.edge[h]] != 0; });
    for (HalfEdgeId h : sides) add_side(k, h);
  }

  /// Returns whether the level below holds a face's children, for this request or another.
  [[nodiscard]] bool has_children(size_t k, FaceId f) const {
    const Buffer<uint32_t>& child = levels_[k + 1].level->child;
    return child.empty() || child[f] != none;
  }
  /// Returns whether the edges inside a divided face were judged. If not, nothing below it was explored.
  [[nodiscard]] bool are_children_judged(size_t k, FaceId f) const {
    if (!has_children(k, f)) return false;
    const HierarchyLevel& below = *levels_[k + 1].level;
    const uint32_t middle_child = below.first_child_of(f) + 3;
    return levels_[k + 1].region.has_edge[below.mesh.topology.edge[3 * middle_child]] != 0;
  }
  /// Returns whether the halves of a side were judged.
  [[nodiscard]] bool are_halves_judged(size_t k, HalfEdgeId h) const {
    if (!has_children(k, h.face())) return false;
    const auto [first, second] = halves(k, h.face(), h % 3);
    const Marks& has_edge = levels_[k + 1].region.has_edge;
    return (has_edge[first] & has_edge[second]) != 0;
  }
  void add_halves(size_t k, HalfEdgeId h) {
    const auto [first, second] = halves(k, h.face(), h % 3);
    for (uint32_t half : {first, second})
      if (may_be_largest(k + 1, half) && levels_[k].shown[mesh_of(k).edge[h]] && levels_[k + 1].shown[half])
        add(k + 1, half);
  }

  /// Adds a split side of a face: its halves if they were judged, else the side.
  void add_side(size_t k, HalfEdgeId h) {
    const LevelChoice& choice = levels_[k];
    const EdgeId e = mesh_of(k).edge[h];
    if (are_halves_judged(k, h)) return add_halves(k, h);
    if (may_be_largest(k, e, split_share(k)) && !is_near(k, e, split_share(k)) && choice.shown[e])
      add(k, e, split_share(k));
  }

  /// Returns whether a share of the edge's deviation may be the largest, by its upper bound.
  [[nodiscard]] bool may_be_largest(size_t k, EdgeId e, double share = 1) const {
    return left_.may_grow_by(share * levels_[k].level->trial.stored_deviation_bound(e), scales_[k]);
  }

  /// Returns the two edges of the level below that side i of a face is split into.
  [[nodiscard]] std::pair<uint32_t, uint32_t> halves(size_t k, FaceId f, uint32_t i) const {
    const HierarchyLevel& below = *levels_[k + 1].level;
    const EdgeId e = mesh_of(k).edge[3 * f + i];
    if (below.child.empty()) return {2 * e, 2 * e + 1};
    const auto half = [&](uint32_t which) {
      return below.mesh.topology.edge[3 * below.child[f] + split_pattern(7, false).outer[2 * i + which]];
    };
    return {half(0), half(1)};
  }

  /// Returns whether a share of the distance from the edge's vertex to its midpoint is too small to matter.
  [[nodiscard]] bool is_near(size_t k, EdgeId e, double share) const {
    const HierarchyLevel& level = *levels_[k].level;
    // A kept level caches its deviations for later views.
    if (level.trial.is_kept) return !left_.may_grow_by(share * level.trial.deviation_bound(level.mesh, e), scales_[k]);
    const Vec3d off = share * (to_double(level.trial.at(e)) - midpoint(level.mesh, e));
    constexpr double rounding = 1 - 1e-6;
    const double least = left_.least_that_matters(scales_[k]);
    return dot(off, off) < rounding * least * least;
  }

  void add(size_t k, EdgeId e, double share = 1) {
    const HierarchyLevel& level = *levels_[k].level;
    left_.add(level.mesh, level.trial, scales_[k], e, share);
  }

  std::span<const LevelChoice> levels_;
  Buffer<double> scales_;    ///< [level] highest pixels per unit
  Buffer<uint8_t> reached_;  ///< [F] whether all ancestors of faces of the current level are divided
  ErrorLeft left_;
};

}  // namespace

ErrorLeft error_left(std::span<const LevelChoice> levels, const Selection& selection) {
  return ErrorFinder(levels, selection).run();
}

}  // namespace papilio
