#pragma once

#include <cstdint>

#include "base/parallel.h"
#include "papilio/buffer.h"
#include "simd/vec3fa.h"

namespace papilio {

/// Sums the contributions of both faces to the new vertex of each edge. The lower face writes, the upper one adds: so
/// faces must come in ascending order.
template <class Real>
struct EdgeAccumulator {
  Vec3T<Real>* sums;  ///< [E]

  /// Of a half-edge of the face, and its edge.
  void add(uint32_t face, uint32_t twin, uint32_t edge, const Wide<Real>& share) const {
    add_share(twin < 3 * face, share, sums[edge]);
  }
  /// Of an edge all of whose faces are known together.
  void set(uint32_t edge, const Wide<Real>& sum) const { store(sum, sums[edge]); }
};

/// Sums contributions of one range of faces, where ranges come in any order or at once. Contributions to edges of an
/// earlier range are deferred until all ranges are through. So a sum is the same to the bit however the faces are cut
/// into ranges.
template <class Real>
class DeferredEdgeAccumulator {
 public:
  DeferredEdgeAccumulator(EdgeAccumulator<Real> shares, uint32_t first_face)
      : shares_(shares), first_half_edge_(3 * first_face) {}

  [[nodiscard]] bool is_early(uint32_t twin) const { return has_threads && twin < first_half_edge_; }
  void add(uint32_t face, uint32_t twin, uint32_t edge, const Wide<Real>& share) {
    if (is_early(twin))
      late_.push_back({edge, share});
    else
      shares_.add(face, twin, edge, share);
  }

  void set(uint32_t edge, const Wide<Real>& sum) const { shares_.set(edge, sum); }

  /// Once all ranges are through.
  void end() const {
    for (const Late& late : late_) add_share(true, late.share, shares_.sums[late.edge]);
  }

 private:
  struct Late {
    uint32_t edge;
    Wide<Real> share;
  };

  EdgeAccumulator<Real> shares_;
  uint32_t first_half_edge_;
  Buffer<Late> late_;
};

}  // namespace papilio
