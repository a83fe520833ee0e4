#pragma once

#include <cstdint>

#include "array.h"
#include "lanes.h"

namespace papilio {

/// Sums of what the two faces of each edge know of its new vertex. Faces come in ascending order, in ranges that may be
/// looked at in any order or at once: the lower face of an edge writes, the upper one adds, after `end` where the lower
/// one is of an earlier range. So a sum is the same to the bit however the faces are cut into ranges.
template <class Real>
class FaceShares {
 public:
  /// `sums` [E]. The range starts at `first_face`.
  FaceShares(Vec3T<Real>* sums, uint32_t first_face) : sums_(sums), first_half_edge_(3 * first_face) {}

  /// Of a half-edge of the face, and its edge.
  void add(uint32_t face, uint32_t twin, uint32_t edge, const Wide<Real>& share) {
    if (twin < first_half_edge_)
      late_.push_back({edge, share});
    else
      add_share(twin < 3 * face, share, sums_[edge]);
  }

  /// Once all ranges are through.
  void end() const {
    for (const Late& late : late_) add_share(true, late.share, sums_[late.edge]);
  }

 private:
  struct Late {
    uint32_t edge;
    Wide<Real> share;
  };

  Vec3T<Real>* sums_;
  uint32_t first_half_edge_;
  Array<Late> late_;
};

}  // namespace papilio
