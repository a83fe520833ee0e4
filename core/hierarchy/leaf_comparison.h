#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/allowed_distance.h"
#include "hierarchy/level_choice.h"
#include "hierarchy/level_surface.h"
#include "hierarchy/near_pieces.h"
#include "hierarchy/patch.h"
#include "hierarchy/progress.h"
#include "hierarchy/result_surface.h"

namespace papilio {

/// Faces of each level that were found to be near enough. [level][F]
using NearFaces = std::vector<Buffer<uint8_t>>;

/// Compares a result with the uniform surface at one leaf, an undivided face, after the other. Below a leaf it descends
/// through the levels, until the sums of the moves further down show that nothing there can matter. Not for threads to
/// share.
///
/// A distance matters if it exceeds the limit, with `rest_` on top of it: what levels further down may add. What comes
/// of one that does is the caller's question. far_faces() and exceeds() keep the limit, and the first ends the leaf.
/// largest_share() raises the limit to it, so that only larger ones matter from then on.
class LeafComparison {
 public:
  /// All references must outlive this. `sums` of moves: see sums_below(). Of
  /// `level_count` levels some may not be explored. `progress` is polled for cancellation; null: never.
  LeafComparison(std::span<const LevelChoice> levels, const std::vector<Buffer<float>>& sums, int level_count,
                 const AllowedDistance& allowed, const Progress* progress)
      : result_(levels),
        sums_(sums),
        level_count_(static_cast<uint32_t>(level_count)),
        allowed_(allowed),
        progress_(progress) {}

  /// Returns the leaves below the coarse faces [first, last), of those not marked in `near`, at which the distance
  /// exceeds the allowed one. Marks the others.
  [[nodiscard]] Buffer<LevelFace> far_faces(NearFaces& near, uint32_t first, uint32_t last);
  /// Returns whether the distance exceeds a share of the allowed one anywhere below the coarse faces [first, last).
  [[nodiscard]] bool exceeds(double share, uint32_t first, uint32_t last);
  /// Returns the largest share of the allowed distance below the coarse faces [first, last), or `known` if that is
  /// larger.
  [[nodiscard]] double largest_share(double known, uint32_t first, uint32_t last);
  /// Returns an upper bound of largest_share(): the largest sum of moves.
  [[nodiscard]] double largest_bound(uint32_t first, uint32_t last);

 private:
  using Points = std::array<PointNear, 3>;     ///< a face's corners, or its new vertices
  using SixPoints = std::array<PointNear, 6>;  ///< a face's corners, then its new vertices
  /// A leaf, or a face below one.
  struct Face {
    uint32_t level;
    FaceId face;
    const Corners& corner;  ///< of the surface
    const Corners& made;    ///< new vertices of the surface
    const Corners& middle;  ///< their places in the result
  };
  /// A child of a face of a level, which itself may not be held.
  struct Child {
    uint32_t level;
    FaceId parent;
    const Corners& corner;
  };
  void begin_with(double share);
  void go_to(const LevelFace& leaf);
  template <class Visit>
  void visit_leaves(uint32_t first, uint32_t last, const Visit& visit);
  template <class Visit>
  void visit_leaves(const LevelFace& face, const Visit& visit);

  [[nodiscard]] double bound_at(const LevelFace& leaf) const;
  [[nodiscard]] bool is_surely_near(const LevelFace& leaf) const;

  void compare(const LevelFace& leaf);
  void compare_below(uint32_t k, FaceId f, const Patch& patch, const Points& corner);
  void compare(const Face& face, const Points& corner, const Patches& below);
  [[nodiscard]] SixPoints points_of(const Face& face, const Points& corner, double enough);
  void compare_new_faces(const Face& face, const Points& corner, const Patches& below);
  void compare_children(const Face& face, const Points& corner, const Patches& below);
  void compare_patch(const Child& child, const Patch& patch);
  void compare_sides(SixPoints& points, unsigned children);
  [[nodiscard]] PointNear near_piece(Vec3d point);
  template <class Near>
  void compare_way(const PointNear& from, const PointNear& to, int depth, const Prisms& prisms, const Near& near);
  void add_rest(const Face& face, const Patches& below);

  [[nodiscard]] bool is_surely_near(const Child& child, const Patch& patch);
  [[nodiscard]] double largest_sum_below(uint32_t k, FaceId f) const;
  [[nodiscard]] PointNear find_near(Vec3d made, Vec3d place, double enough);

  /// Returns whether a squared distance, with `rest_` added to its root, exceeds the limit.
  [[nodiscard]] bool matters(double squared) const { return !is_far_ && squared > enough(); }
  [[nodiscard]] double enough() const;
  void note(double squared);

  ResultSurface result_;
  LevelSurface surface_{result_};
  NearPieces near_{result_};
  Prisms new_faces_;  ///< of the surface, near the patch at hand
  const std::vector<Buffer<float>>& sums_;
  uint32_t level_count_;
  const AllowedDistance& allowed_;
  const Progress* progress_;
  uint32_t visited_ = 0;         ///< leaves
  double squared_share_ = 0;     ///< share of the allowed distance above which distances matter
  double allowed_here_ = 1;      ///< distance, at the leaf at hand
  double limit_ = 0;             ///< squared distance above which one matters at the leaf at hand
  bool has_grown_ = false;       ///< whether a distance raised squared_share_
  double rest_ = 0;              ///< upper bound of what levels further down add at the face at hand
  bool stops_at_limit_ = false;  ///< a distance above the limit ends the comparison of a leaf
  LevelFace leaf_{};             ///< at hand
  bool is_far_ = false;          ///< a distance above the limit was found
};

}  // namespace papilio
