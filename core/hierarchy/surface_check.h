#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/allowed_distance.h"
#include "hierarchy/leaf_comparison.h"

// Two-sided distance between a result and the uniform surface, as far as its levels hold it.
//
// Each vertex of the surface is compared with its place on the result, the point with its barycentric coordinates on
// the same undivided face. If the two are further apart than allowed, the vertex is compared with the nearest point of
// the result, and so are the sides between them that no single piece of the result is near to. The result is compared
// with the surface where it is bent, along the sides of its faces: elsewhere a point is as near to the surface as the
// surface's vertices are to the result. Not so above a pit of a very rough surface: of 6,000 results on random moves of
// up to three quarters of a tube's radius two were further away than allowed, by 4 % at most.

namespace papilio {

class SurfaceCheck {
 public:
  /// Of `level_count` levels some may not be explored. References must outlive this object, and no level may be added.
  /// Sums of moves below `share_known` of the allowed distance may be bounded loosely.
  /// Works on as many threads as `progress` allows, and polls it for cancellation.
  SurfaceCheck(std::span<const LevelChoice> levels, int level_count, AllowedDistance allowed, double share_known,
               const Progress& progress);

  /// Returns the undivided faces, of those not marked in `near`, at which the distance exceeds the allowed one, in the
  /// order of their coarse faces. Marks the others. O(faces of the levels' regions).
  [[nodiscard]] Buffer<LevelFace> far_faces(NearFaces& near) const;

  /// Returns whether any distance exceeds a share of the allowed one. Ends early where one does.
  [[nodiscard]] bool exceeds(double share) const;

  /// Returns an upper bound of the distances as shares of the allowed one, which must not be 0. Below a face that was
  /// not explored half of its largest move is added, where a smooth surface moves by a third.
  [[nodiscard]] double largest_share() const;
  /// Returns an upper bound of largest_share(): the largest sum of moves at an undivided face. In a view it also covers
  /// what shows of faces that count as hidden.
  [[nodiscard]] double largest_bound() const;

 private:
  template <class Found, class Find>
  [[nodiscard]] std::vector<Found> compare(const Find& find) const;

  std::span<const LevelChoice> levels_;
  int level_count_;
  AllowedDistance allowed_;
  const Progress& progress_;
  std::vector<Buffer<float>> sums_;  ///< of moves (move_bounds.h); faces with small sums are not compared
};

}  // namespace papilio
