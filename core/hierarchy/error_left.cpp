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

/// Finds the largest deviation left at the edges of the faces that are not divided. Edges are looked at in their
/// level's order; which of them count is asked only of those that may matter.
class ErrorFinder {
 public:
  ErrorFinder(std::span<const LevelChoice> levels, const Selection& selection) : levels_(levels), left_(selection) {
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
  /// What is left of a deviation of level k where its edge is split: nothing of the last one of detail, which is the
  /// surface itself.
  [[nodiscard]] double split_share(size_t k) const { return levels_[k].level->detail_levels == 1 ? 0 : split_leaves; }
  [[nodiscard]] const Topology& mesh_of(size_t k) const { return levels_[k].level->mesh.topology; }

  /// Finds the faces of the level's region above which all are divided.
  void find_reached(size_t k) {
    const LevelChoice& choice = levels_[k];
    if (k == 0) {
      reached_.assign(mesh_of(0).face_count(), 1);
      return;
    }
    Buffer<uint8_t> below(mesh_of(k).face_count(), 0);
    for (size_t i = 0; i < choice.region.faces.size(); i += 4) {
      const uint32_t f = choice.region.faces[i];
      const uint32_t parent = choice.level->parent_of(f);
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

  /// Whether an edge that stays may have the largest deviation. (Its error in the choice does not tell: that may be of
  /// what lies below.)
  [[nodiscard]] bool may_matter(const HierarchyLevel& level, uint32_t e, double scale) const {
    const double most = level.trial.no_less_than_deviation_at(e);
    return left_.may_grow_by(most, scale) && left_.may_grow_at(level.mesh, e, most);
  }

  void add_whole(size_t k) {
    const LevelChoice& choice = levels_[k];
    const Topology& mesh = mesh_of(k);
    const Trial& trial = choice.level->trial;
    if (trial.bounds.empty()) {
      add_far(k);
    } else {
      float too_little = surely_too_little(k);
      // Of a level that was kept most are known to be too little; of a new one nobody can guess which are split.
      Buffer<uint32_t> edges = choice.region.edges();
      if (!trial.is_kept) keep_if(edges, [&](uint32_t e) { return choice.split[e] == 0; });
      for (uint32_t e : edges) {
        if (trial.no_less_than_deviation_at(e) < too_little || choice.split[e] != 0) continue;
        if (!may_matter(*choice.level, e, scales_[k]) || is_near(k, e, 1)) continue;
        add_whole(k, e);
        too_little = surely_too_little(k);
      }
    }
    for (uint32_t h : choice.level->shared) {
      const uint32_t e = mesh.edge[h];
      if (choice.region.has_edge[e] != 0 && choice.split[e] == 0 && choice.shown[e] && reached_[Topology::face(h)] != 0)
        add(k, e);
    }
  }

  /// An edge of the region that stays.
  void add_whole(size_t k, uint32_t e) {
    const Topology& mesh = mesh_of(k);
    const uint32_t h = mesh.half_edge[e];
    const uint32_t t = mesh.twin[h];
    if (reached_[Topology::face(h)] == 0 && (t == none || reached_[Topology::face(t)] == 0)) return;
    if (levels_[k].shown[e]) add(k, e);
  }

  /// The same for all of the region's edges, and for those that are split, where nothing is known of deviations: those
  /// are looked at whose vertex is far enough from the middle.
  void add_far(size_t k) {
    const Topology& mesh = mesh_of(k);
    if (k == 0) {
      FarFinder far(*this, 0);
      for (uint32_t e = 0; e < mesh.edge_count(); ++e) {
        const uint32_t h = mesh.half_edge[e];
        far.look_at(e, far.position(mesh.origin[h]), far.position(mesh.tip(h)));
      }
      return;
    }
    FarFinder far(*this, k);
    const Buffer<uint32_t>& faces = levels_[k].region.faces;
    for (size_t i = 0; i < faces.size(); i += 4) {
      if (reached_[faces[i]] == 0 || are_all_divided(levels_[k], faces[i])) continue;
      const uint32_t h = 3 * faces[i];
      const std::array<uint32_t, 6> vertex = vertices_of_four(&mesh.origin[h]);
      std::array<Vec3fa, 6> at;
      for (uint32_t c = 0; c < 6; ++c) at[c] = far.position(vertex[c]);
      const uint32_t* edge = &mesh.edge[h];
      Vec3fa farthest{};
      visit_edges_of_four([&](uint32_t half_edge, uint32_t from, uint32_t to) __attribute__((always_inline)) {
        farthest = larger(far.weighed(edge[half_edge], at[from], at[to]), farthest);
      });
      if (!far.is_too_near(farthest)) [[unlikely]]
        far.look_at_four(edge, at);
    }
  }

  /// Whether each of the four children of a face is divided in its turn: then nothing of them is in the result.
  [[nodiscard]] static bool are_all_divided(const LevelChoice& choice, uint32_t child) {
    if (choice.red.empty()) return false;
    const uint8_t* red = &choice.red[child];
    if ((red[0] & red[1] & red[2] & red[3]) == 0) return false;
    if (choice.at_outline.empty()) return true;
    unsigned mask = 7;
    for (uint32_t c = 0; c < 4; ++c) mask &= choice.split_mask(child + c);
    return mask == 7;
  }

  /// Looks at the edges of one level, as above.
  class FarFinder {
   public:
    FarFinder(ErrorFinder& of, size_t k)
        : of_(of),
          k_(k),
          choice_(of.levels_[k]),
          may_be_split_(choice_.region.has_edge.data()),
          is_split_(choice_.split.data()),
          positions_(choice_.level->mesh.positions.data()),
          made_(choice_.level->trial.made.data()),
          share_squared_{no_share, no_share, 1, static_cast<float>(of.split_share(k) * of.split_share(k))},
          too_near_(choice_.level->box.largest_coordinate()) {
      too_near_.raise(of_.left_.least_that_matters(of_.scales_[k_]));
    }
    [[nodiscard, gnu::always_inline]] Vec3fa position(uint32_t vertex) const { return widen(positions_[vertex]); }
    /// How far an edge's vertex is from the middle, squared, in each direction, and as its share counts: not at all
    /// where the edge does not. (What is read of such an edge may not even be a number.)
    [[nodiscard, gnu::always_inline]] Vec3fa weighed(uint32_t e, Vec3fa from, Vec3fa to) const {
      const Vec3fa off = widen(made_[e]) - 0.5F * (from + to);
      return {share_squared_[2 * may_be_split_[e] + is_split_[e]] * (off.v * off.v)};
    }
    /// Of the largest of each direction of some edges: whether all of these are too little to matter.
    [[nodiscard, gnu::always_inline]] bool is_too_near(Vec3fa farthest) const {
      return farthest.v[0] + farthest.v[1] + farthest.v[2] <= too_near_.squared();
    }
    void look_at(uint32_t e, Vec3fa from, Vec3fa to) {
      const Vec3fa parts = weighed(e, from, to);
      if (parts.v[0] + parts.v[1] + parts.v[2] > too_near_.squared()) [[unlikely]]
        add(e);
    }
    /// At the nine edges of the four children of a face, of their 12 half-edges' and between their vertices.
    [[gnu::noinline]] void look_at_four(const uint32_t* edge, const std::array<Vec3fa, 6>& at) {
      visit_edges_of_four(
          [&](uint32_t half_edge, uint32_t from, uint32_t to) { look_at(edge[half_edge], at[from], at[to]); });
    }

   private:
    static constexpr float no_share = -std::numeric_limits<float>::infinity();

    void add(uint32_t e) {
      if (choice_.split[e] == 0)
        of_.add_whole(k_, e);
      else if (k_ + 1 == of_.levels_.size())
        of_.add_last_split(k_, e);
      else
        of_.add_split_far(k_, e);
      too_near_.raise(of_.left_.least_that_matters(of_.scales_[k_]));
    }

    ErrorFinder& of_;
    size_t k_;
    const LevelChoice& choice_;
    const uint8_t *may_be_split_, *is_split_;
    const Vec3f *positions_, *made_;
    std::array<float, 4> share_squared_;  ///< by whether the edge may be split (2), and whether it is (1)
    DeviationCutoff too_near_;
  };

  /// Of the last level nothing below was judged.
  void add_last_split(size_t k) {
    const LevelChoice& choice = levels_[k];
    if (choice.level->trial.bounds.empty()) return;  // add_far did it
    for (uint32_t e : choice.split_edges)
      if (may_be_largest(k, e, split_share(k)) && !is_near(k, e, split_share(k))) add_last_split(k, e);
  }
  void add_last_split(size_t k, uint32_t e) {
    if (levels_[k].shown[e]) add(k, e, split_share(k));
  }

  void add_split(size_t k) {
    const LevelChoice& choice = levels_[k];
    if (choice.level->trial.bounds.empty()) return add_sides_at_outline(k);  // add_far did the others
    has_children_ = choice.with_children();
    Buffer<uint32_t> faces = choice.faces_at_split();
    keep_if(faces, [&](uint32_t f) {
      const bool has_children = has_children_[f] != 0;
      const bool is_whole_or_cut = choice.split_mask(f) != 7;
      const bool is_reached = reached_[f] != 0;
      return is_reached & (!has_children | is_whole_or_cut);
    });
    Buffer<uint32_t> sides(3 * faces.size());
    for (size_t i = 0; i < faces.size(); ++i)
      for (uint32_t c = 0; c < 3; ++c) sides[3 * i + c] = 3 * faces[i] + c;
    const Topology& mesh = mesh_of(k);
    keep_if(sides, [&](uint32_t h) { return choice.split[mesh.edge[h]] != 0; });
    for (uint32_t h : sides) add_side(k, h);
  }

  /// The sides that are split of faces at an outline that are not divided.
  void add_sides_at_outline(size_t k) {
    const LevelChoice& choice = levels_[k];
    for (uint32_t f : choice.at_outline) {
      if (reached_[f] == 0 || choice.split_mask(f) == 7) continue;
      for (uint32_t h = 3 * f; h < 3 * f + 3; ++h)
        if (choice.split[mesh_of(k).edge[h]] != 0 && are_halves_judged(k, h)) add_halves(k, h);
    }
  }

  /// Of a side whose face has children.
  [[nodiscard]] bool are_halves_judged(size_t k, uint32_t h) const {
    const auto [first, second] = halves(k, Topology::face(h), h % 3);
    const EdgeMarks& has_edge = levels_[k + 1].region.has_edge;
    return (has_edge[first] & has_edge[second]) != 0;
  }
  void add_halves(size_t k, uint32_t h) {
    const auto [first, second] = halves(k, Topology::face(h), h % 3);
    for (uint32_t half : {first, second})
      if (may_be_largest(k + 1, half) && levels_[k].shown[mesh_of(k).edge[h]] && levels_[k + 1].shown[half])
        add(k + 1, half);
  }

  /// A side of a face, which is split: its halves may have been judged, though nothing below was wanted.
  void add_side(size_t k, uint32_t h) {
    const LevelChoice& choice = levels_[k];
    const uint32_t e = mesh_of(k).edge[h];
    if (has_children_[Topology::face(h)] != 0 && are_halves_judged(k, h)) return add_halves(k, h);
    if (may_be_largest(k, e, split_share(k)) && !is_near(k, e, split_share(k)) && choice.shown[e])
      add(k, e, split_share(k));
  }

  /// An edge that is split where errors do not decide, so that what is below it is not judged unless all of a face is
  /// divided, or at an outline.
  void add_split_far(size_t k, uint32_t e) {
    const LevelChoice& choice = levels_[k];
    const Topology& mesh = mesh_of(k);
    const auto is_cut = [&](uint32_t h) {
      return h != none && reached_[Topology::face(h)] != 0 && choice.split_mask(Topology::face(h)) != 7;
    };
    bool is_any_cut = is_cut(mesh.half_edge[e]) || is_cut(mesh.twin[mesh.half_edge[e]]);
    if (mesh.kind[e] == EdgeKind::shared)
      for (uint32_t h : choice.level->shared) is_any_cut |= mesh.edge[h] == e && is_cut(h);
    if (is_any_cut && choice.shown[e] && !is_judged_at_outline(k, mesh.half_edge[e])) add(k, e, split_share(k));
  }

  [[nodiscard]] bool is_judged_at_outline(size_t k, uint32_t h) const {
    const LevelChoice& choice = levels_[k];
    return !choice.at_outline.empty() && choice.red[Topology::face(h)] != 0 && are_halves_judged(k, h);
  }

  /// By what is known of the deviation.
  [[nodiscard]] bool may_be_largest(size_t k, uint32_t e, double share = 1) const {
    return left_.may_grow_by(share * levels_[k].level->trial.no_less_than_deviation_at(e), scales_[k]);
  }

  /// The two edges of the level below that side i of a face is split into.
  [[nodiscard]] std::pair<uint32_t, uint32_t> halves(size_t k, uint32_t f, uint32_t i) const {
    const HierarchyLevel& below = *levels_[k + 1].level;
    const uint32_t e = mesh_of(k).edge[3 * f + i];
    if (below.child.empty()) return {2 * e, 2 * e + 1};
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
    if (level.trial.is_kept)
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
  Buffer<double> scales_;         ///< [level] the highest pixels per unit
  Buffer<uint8_t> has_children_;  ///< [F] of a level of which splits are looked at
  Buffer<uint8_t> reached_;       ///< [F] of the level at hand: whether all faces above are divided
  ErrorLeft left_;
};

}  // namespace

ErrorLeft error_left(std::span<const LevelChoice> levels, const Selection& selection) {
  return ErrorFinder(levels, selection).run();
}

}  // namespace papilio
