#include "hierarchy/surface_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "hierarchy/level_surface.h"
#include "hierarchy/move_bounds.h"
#include "hierarchy/patch.h"
#include "hierarchy/prism.h"
#include "split/split_pattern.h"

namespace papilio {
namespace {

/// Compares a result with the surface, one undivided face after the other.
class Comparison {
 public:
  /// `progress` is asked whether to stop; null: nobody is.
  Comparison(std::span<const LevelChoice> levels, double most_cosine, const std::vector<Buffer<float>>& sums,
             const AllowedDistance& allowed, const Progress* progress)
      : result_(levels, most_cosine), sums_(sums), allowed_(allowed), progress_(progress) {}

  /// Below the coarse faces from `first` to the one before `last`.
  Buffer<LevelFace> far_faces(int level_count, NearFaces& near, uint32_t first, uint32_t last) {
    begin_with(1);
    stops_at_limit_ = true;
    level_count_ = static_cast<uint32_t>(level_count);
    Buffer<LevelFace> far;
    visit_leaves(first, last, [&](const LevelFace& leaf) {
      uint8_t& is_near = near[leaf.level][leaf.face];
      if (is_near != 0 || is_surely_near(leaf)) return;
      look_at_leaf(leaf);
      if (is_far_)
        far.push_back(leaf);
      else
        is_near = 1;
    });
    return far;
  }

  /// The largest share, if it is larger than `known`; else that.
  double largest_share(double known, int level_count, uint32_t first, uint32_t last) {
    begin_with(known);
    level_count_ = static_cast<uint32_t>(level_count);
    visit_leaves(first, last, [&](const LevelFace& leaf) {
      if (!is_surely_near(leaf)) look_at_leaf(leaf);
    });
    return has_grown_ ? std::sqrt(squared_share_) : known;
  }

  double largest_bound(uint32_t first, uint32_t last) {
    double most = 0;
    visit_leaves(first, last,
                 [&](const LevelFace& leaf) { most = std::max(most, bound_at(leaf) / allowed_.at(leaf)); });
    return most;
  }

 private:
  void begin_with(double share) {
    squared_share_ = limit_ = share * share;
    allowed_here_ = 1;
    has_grown_ = false;
  }
  /// Has distances held against what is allowed at a face.
  void go_to(const LevelFace& leaf) {
    const double allowed = allowed_.at(leaf);
    if (allowed == allowed_here_ || allowed == AllowedDistance::any) return;
    limit_ = squared_share_ * allowed * allowed;
    allowed_here_ = allowed;
  }

  template <class Visit>
  void visit_leaves(uint32_t first, uint32_t last, const Visit& visit) {
    for (uint32_t f = first; f < last; ++f) visit_leaves({0, f}, visit);
  }
  template <class Visit>
  void visit_leaves(const LevelFace& face, const Visit& visit) {
    const auto [k, f] = face;
    if (!result_.is_divided(k, f)) {
      if (++visited_ % leaves_between_polls == 0 && progress_ != nullptr) progress_->poll();
      visit(face);
      return;
    }
    const uint32_t child = result_.first_child(k, f);
    for (uint32_t c = 0; c < 4; ++c) visit_leaves({k + 1, child + c}, visit);
  }

  /// Upper bound of the distance at an undivided face. The diagonal of a transition face may be further from the
  /// surface than all of the face would be.
  [[nodiscard]] double bound_at(const LevelFace& leaf) const {
    const double sum = sums_[leaf.level][leaf.face];
    return result_.choice(leaf.level).split_mask(leaf.face) == 0 ? sum : along_diagonal * sum;
  }
  [[nodiscard]] bool is_surely_near(const LevelFace& leaf) const {
    const double bound = bound_at(leaf) * (allowed_here_ / allowed_.at(leaf));
    return bound * bound <= limit_;
  }

  void look_at_leaf(const LevelFace& leaf) {
    go_to(leaf);
    leaf_ = leaf;
    is_far_ = false;
    prisms_.clear();
    const auto [k, f] = leaf;
    const unsigned mask = result_.choice(k).split_mask(f);
    const Corners corner = result_.corners(k, f);
    const Corners made = result_.new_vertices(k, f, corner);
    Corners middle = middles_of(corner);
    for (uint32_t i = 0; i < 3; ++i)
      if ((mask >> i & 1U) != 0) middle[i] = made[i];
    const unsigned sides = sides_to_look_at();
    Patches below = patches_over(corner, middle, sides);
    const auto add_ridge_inside = [&](uint32_t child) {
      below[child].ridges |= 1U << inner_side[child];
      below[3].ridges |= 1U << side_of_middle_child[child];
    };
    const uint32_t i = first_target[mask];
    const uint32_t opposite = (i + 2) % 3;
    if (mask == 7) {
      for (uint32_t child = 0; child < 3; ++child) add_ridge_inside(child);
    } else if (has_two_targets(mask)) {
      add_ridge_inside((i + 1) % 3);
      if (result_.has_second_diagonal(k, f, mask))
        bend_along(below, opposite, middle[i], corner[opposite]);
      else
        bend_along(below, i, middle[(i + 1) % 3], corner[i]);
    } else if (mask != 0) {
      bend_along(below, opposite, middle[i], corner[opposite]);
    }
    look_at(k, f, {.corner = corner, .made = made, .middle = middle, .on_ridge = sides}, below);
  }

  /// By bits: of two leaves one looks at the side between them, but that may be one that is not looked at. Of two
  /// levels it is the finer, below which as much was explored.
  [[nodiscard]] unsigned sides_to_look_at() {
    const auto [k, f] = leaf_;
    const Topology& mesh = result_.topology(k);
    unsigned sides = 0;
    for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
      result_.find_beside(leaf_, h % 3, beside_);
      const bool is_own =
          beside_.empty() || beside_[0].level < k || (beside_[0].level == k && mesh.half_edge[mesh.edge[h]] == h);
      const auto is_left_out = [&](const LevelFace& beside) { return is_surely_near(beside); };
      if (is_own || std::ranges::any_of(beside_, is_left_out)) sides |= 1U << h % 3;
    }
    return sides;
  }

  /// A face below an undivided one, or that itself.
  struct Face {
    const Corners& corner;  ///< of the surface
    const Corners& made;    ///< of the surface: the new vertices
    const Corners& middle;  ///< the places of these in the result
    unsigned on_ridge;      ///< those of the places, by bits, where the result is bent
  };

  void look_below(uint32_t k, uint32_t f, const Patch& patch) {
    const Corners corner = result_.corners(k, f);
    const Corners made = result_.new_vertices(k, f, corner);
    const Corners middle = patch.middles();
    const unsigned on_bend = patch.bent_side == none ? 0 : 1U << patch.bent_side;
    look_at(k, f, {.corner = corner, .made = made, .middle = middle, .on_ridge = patch.ridges | on_bend},
            patches_below(patch, middle));
  }

  void look_at(uint32_t k, uint32_t f, const Face& face, const Patches& below) {
    if (is_far_) return;
    const bool is_explored = k + 1 >= level_count_ || result_.has_children(k, f);
    rest_ = stops_at_limit_ && !is_explored ? share_of_sum * sums_[k][f] : 0;
    for (uint32_t i = 0; i < 3; ++i) {
      if (matters(squared_norm(face.made[i] - face.middle[i]))) look_at_vertex(k, f, i, face);
    }
    if (result_.has_children(k, f)) {
      const uint32_t child = result_.first_child(k, f);
      for (uint32_t c = 0; c < 4; ++c) look_below(k + 1, child + c, below[c]);
      return;
    }
    const bool samples_between = is_explored || !stops_at_limit_;  // else the rest is more than is missed between
    const std::array<Corners, 4> children = children_of(face.corner, face.made);
    for (uint32_t c = 0; c < 4 && samples_between; ++c)
      if (below[c].bent_side != none || matters(largest_squared_distance(below[c].corner, children[c])))
        look_at_patch(k, f, below[c], children[c]);
    if (!is_explored && !stops_at_limit_) look_at_rest(k, f, face, below);
  }

  /// The new vertex of side i, which is not at its place.
  void look_at_vertex(uint32_t k, uint32_t f, uint32_t i, const Face& face) {
    if (!has_near(face.made[i])) note(result_.squared_distance_from(leaf_, face.made[i], limit_));
    if ((face.on_ridge >> i & 1U) == 0 || is_far_) return;
    // From the deepest face at the vertex on: there it is corner i + 1 of child i.
    if (result_.has_children(k, f)) {
      f = result_.first_child(k, f) + i;
      for (++k; result_.has_children(k, f); ++k) f = result_.first_child(k, f) + (i + 1) % 3;
    }
    note(surface_.squared_distance({k, f}, leaf_.level, face.middle[i], enough()));
  }

  /// Child c of a face below which no other is held.
  void look_at_patch(uint32_t k, uint32_t f, const Patch& patch, const Corners& triangle) {
    const auto distance_at = [&](Vec3d point) {
      double squared = squared_height_above(triangle, point);
      if (matters(squared)) squared = surface_.squared_distance({k, f}, leaf_.level, point, enough());
      note(squared);
      return squared;
    };
    const auto look_at_line = [&](Vec3d from, Vec3d to) {
      if (distance_at(middle_of(from, to)) < quiet * limit_) return;
      for (const double share : {0.25, 0.75}) (void)distance_at(from + share * (to - from));
    };
    (void)distance_at(1.0 / 3 * (patch.corner[0] + patch.corner[1] + patch.corner[2]));
    for (uint32_t i = 0; i < 3; ++i)
      if ((patch.ridges >> i & 1U) != 0) look_at_line(patch.corner[i], patch.corner[(i + 1) % 3]);
    if (patch.bent_side == none) return;
    (void)distance_at(patch.bend);
    look_at_line(patch.bend, patch.opposite_bend());
  }

  /// A face below which further levels may add to the distances.
  void look_at_rest(uint32_t k, uint32_t f, const Face& face, const Patches& below) {
    const Corners place{below[0].corner[0], below[1].corner[1], below[2].corner[2]};
    const double apart = std::sqrt(
        std::max(largest_squared_distance(face.corner, place), largest_squared_distance(face.made, face.middle)));
    const double offset = std::sqrt(largest_squared_distance(face.made, middles_of(face.corner)));
    const auto may_matter = [&](double distance, double rest) {
      return matters((distance + rest) * (distance + rest));
    };
    if (!may_matter(apart, share_of_rest * offset)) return;
    double most = 0;
    for (uint32_t i = 0; i < 3; ++i) most = std::max(most, squared_move(k, 3 * f + i, face.made[i]));
    const double rest = share_of_rest * std::sqrt(most);
    const double enough = std::max(0.0, std::sqrt(limit_) - rest);
    const auto add = [&](Vec3d vertex, Vec3d at) {
      if (!may_matter(length(vertex - at), rest)) return;
      const double distance = std::sqrt(result_.squared_distance_from(leaf_, vertex, enough * enough));
      note((distance + rest) * (distance + rest));
    };
    for (uint32_t i = 0; i < 3; ++i) {
      add(face.corner[i], place[i]);
      add(face.made[i], face.middle[i]);
    }
  }

  /// How far the surface moves where the edge of a half-edge is split, squared: the vertex from the faces as they are,
  /// or the middle of the edge from the faces as they will be.
  [[nodiscard]] double squared_move(uint32_t k, uint32_t h, Vec3d made) const {
    const Topology& mesh = result_.topology(k);
    const auto at = [&](uint32_t v) { return to_double(result_.level(k).mesh.positions[v]); };
    const Vec3d a = at(mesh.origin[h]);
    const Vec3d b = at(mesh.tip(h));
    const Vec3d middle = middle_of(a, b);
    double from_old = squared_norm(made - middle);
    double from_new = from_old;
    const auto add_face = [&](uint32_t half_edge) {
      const Vec3d apex = at(mesh.apex(half_edge));
      from_old = std::min(from_old, squared_distance(made, {a, b, apex}));
      from_new =
          std::min({from_new, squared_distance(middle, {a, made, apex}), squared_distance(middle, {made, b, apex})});
    };
    add_face(h);
    if (mesh.twin[h] != none) add_face(mesh.twin[h]);
    return std::max(from_old, from_new);
  }

  /// Whether a distance, squared, is above what is allowed, or what was found before.
  [[nodiscard]] bool matters(double squared) const { return !is_far_ && squared > enough(); }
  [[nodiscard]] double enough() const {
    if (rest_ == 0) return limit_;
    const double left = std::max(0.0, std::sqrt(limit_) - rest_);
    return left * left;
  }

  void note(double squared) {
    if (!matters(squared)) return;
    if (stops_at_limit_) {
      is_far_ = true;
    } else {
      limit_ = squared;
      squared_share_ = squared / (allowed_here_ * allowed_here_);
      has_grown_ = true;
    }
  }

  /// Whether the vertex is surely near the leaf at hand.
  [[nodiscard]] bool has_near(Vec3d vertex) {
    if (prisms_.empty()) {
      result_.find_pieces(leaf_, pieces_);
      for (const TriangleCorners& piece : pieces_) prisms_.emplace_back(piece);
    }
    return std::ranges::any_of(prisms_, [&](const Prism& prism) { return prism.has_near(vertex, limit_); });
  }

  static constexpr double share_of_sum = 0.25;  ///< of a move and its rest: what the further ones add
  static constexpr double share_of_rest = 0.5;  ///< of a move: all further ones together are a third where it is smooth
  static constexpr double along_diagonal = 2;
  static constexpr uint32_t leaves_between_polls = 1024;
  static constexpr double quiet = 0.36;  ///< share of the limit, squared, below which no more samples are taken beside

  ResultSurface result_;
  LevelSurface surface_{result_};
  const std::vector<Buffer<float>>& sums_;
  const AllowedDistance& allowed_;
  const Progress* progress_;
  uint32_t visited_ = 0;      ///< leaves
  double squared_share_ = 0;  ///< of what is allowed: what distances must exceed for them to matter
  double allowed_here_ = 1;   ///< at the leaf at hand
  double limit_ = 0;          ///< the same there, as a squared distance
  bool has_grown_ = false;    ///< that, by a distance found
  double rest_ = 0;           ///< what further levels may add at the face at hand
  uint32_t level_count_ = 0;  ///< the rest that levels up to this one add is counted
  bool stops_at_limit_ = false;
  LevelFace leaf_{};                     ///< at hand
  bool is_far_ = false;                  ///< which is beyond the limit
  std::vector<TriangleCorners> pieces_;  ///< of it
  std::vector<Prism> prisms_;            ///< of these; empty while nobody has asked
  std::vector<LevelFace> beside_;
};

}  // namespace

SurfaceCheck::SurfaceCheck(std::span<const LevelChoice> levels, double most_cosine, int level_count,
                           AllowedDistance allowed, double share_known, const Progress& progress)
    : levels_(levels),
      most_cosine_(most_cosine),
      level_count_(level_count),
      allowed_(std::move(allowed)),
      progress_(progress),
      sums_(sums_below(levels, level_count, share_known * allowed_.least())) {}

/// What `find` returns for each part of the coarse faces.
template <class Found, class Find>
std::vector<Found> SurfaceCheck::compare(const Find& find) const {
  const uint32_t count = levels_[0].level->mesh.topology.face_count();
  uint64_t faces = 0;
  for (const LevelChoice& choice : levels_) faces += choice.region.faces.size();
  const uint32_t parts =
      std::min(count, parts_of(static_cast<uint32_t>(std::min<uint64_t>(faces, none)), progress_.threads()));
  std::vector<Found> found(parts);
  for_each_part(parts, count, [&](uint32_t part, uint32_t first, uint32_t last) {
    // The first part is that of the calling thread, which alone may ask.
    Comparison comparison(levels_, most_cosine_, sums_, allowed_, part == 0 ? &progress_ : nullptr);
    found[part] = find(comparison, first, last);
  });
  return found;
}

Buffer<LevelFace> SurfaceCheck::far_faces(NearFaces& near) const {
  Buffer<LevelFace> far;
  for (const Buffer<LevelFace>&of_part :
       compare<Buffer<LevelFace>>([&](Comparison&comparison, uint32_t first, uint32_t last) {
         return comparison.far_faces(level_count_, near, first, last);
       }))
    far.insert(far.end(), of_part.begin(), of_part.end());
  return far;
}

double SurfaceCheck::largest_bound() const {
  return std::ranges::max(compare<double>(
      [](Comparison& comparison, uint32_t first, uint32_t last) { return comparison.largest_bound(first, last); }));
}

double SurfaceCheck::largest_share() const {
  const double most = largest_bound();
  // Few distances are much smaller than the sum of the moves: what is above a guess is looked at.
  for (const double guess : {0.8 * most, 0.2 * most, 0.0}) {
    const double found = std::ranges::max(compare<double>([&](Comparison& comparison, uint32_t first, uint32_t last) {
      return comparison.largest_share(guess, level_count_, first, last);
    }));
    if (found > guess) return found;
  }
  return 0;
}

}  // namespace papilio
