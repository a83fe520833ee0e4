#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/allowed_distance.h"
#include "hierarchy/level_choice.h"
#include "hierarchy/progress.h"
#include "hierarchy/result_surface.h"

// The distance between a result and the uniform surface, as far as its levels hold it: from both sides.
//
// Each vertex of the surface is compared with its place on the result, the point with its barycentric coordinates below
// the same undivided face. Where the two are further apart than allowed, the vertex is compared with the nearest point
// of the result. The result is compared with the surface where it is bent, along the sides of its faces: elsewhere a
// point is as far from the surface as a vertex of that is from the result.

namespace papilio {

/// Faces of each level that were found to be near enough. [level][F]
using NearFaces = std::vector<Buffer<uint8_t>>;

class SurfaceCheck {
 public:
  /// Of `level_count` levels some may be missing, where they were not explored. All must outlive this, and no level may
  /// be added. `most_cosine`: see transition.h. Sums of moves below `share_known` of what is allowed may be bounded
  /// loosely. Works with as many threads as `progress` allows, and asks it now and then whether to stop.
  SurfaceCheck(std::span<const LevelChoice> levels, double most_cosine, int level_count, AllowedDistance allowed,
               double share_known, const Progress& progress);

  /// The undivided faces, of those not marked in `near`, at which the distance exceeds what is allowed, in the order of
  /// their coarse faces. Marks the others. O(faces of the levels' regions).
  [[nodiscard]] Buffer<LevelFace> far_faces(NearFaces& near) const;

  /// Upper bound of the distances as shares of what is allowed, which must not be 0. Below a face that was not explored
  /// half of its largest move is added, where a smooth surface moves by a third.
  [[nodiscard]] double largest_share() const;
  /// The same, looser: the sums of moves at the undivided faces. O(faces of the levels' regions), and little.
  [[nodiscard]] double largest_bound() const;

 private:
  template <class Found, class Find>
  [[nodiscard]] std::vector<Found> compare(const Find& find) const;

  std::span<const LevelChoice> levels_;
  double most_cosine_;
  int level_count_;
  AllowedDistance allowed_;
  const Progress& progress_;
  std::vector<Buffer<float>> sums_;  ///< of moves (move_bounds.h): few faces with small ones are looked at
};

}  // namespace papilio
