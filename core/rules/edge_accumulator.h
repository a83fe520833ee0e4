#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/ids.h"
#include "base/index_range.h"
#include "base/parallel.h"
#include "papilio/mesh.h"
#include "simd/vec3fa.h"

namespace papilio {

/// Sums the contributions of both faces to the new vertex of each edge. The lower face writes, the upper one adds: so
/// faces must come in ascending order.
template <class Real>
struct EdgeAccumulator {
  Vec3T<Real>* sums;  ///< [E]

  /// Adds the contribution of a face to one of its edges; `twin` is the half-edge across the edge.
  void add(FaceId face, uint32_t twin, EdgeId edge, const Wide<Real>& share) const {
    add_share(twin < 3 * face, share, sums[edge]);
  }
  /// Sets the sum of an edge all of whose contributions are known.
  void set(EdgeId edge, const Wide<Real>& sum) const { store(sum, sums[edge]); }
};

/// Sums contributions of one range of faces, where ranges come in any order or concurrently. Contributions to edges of
/// an earlier range are deferred until all ranges are complete. So sums are bit-identical for any division into ranges.
template <class Real>
class DeferredEdgeAccumulator {
 public:
  DeferredEdgeAccumulator(EdgeAccumulator<Real> shares, uint32_t first_face)
      : shares_(shares), first_half_edge_(3 * first_face) {}

  [[nodiscard]] bool is_early(uint32_t twin) const { return has_threads && twin < first_half_edge_; }
  void add(FaceId face, uint32_t twin, EdgeId edge, const Wide<Real>& share) {
    if (is_early(twin))
      late_.push_back({edge, share});
    else
      shares_.add(face, twin, edge, share);
  }

  void set(EdgeId edge, const Wide<Real>& sum) const { shares_.set(edge, sum); }

  /// Adds the deferred contributions. To be called when all ranges are complete.
  void end() const {
    for (const Late& late : late_) add_share(true, late.share, shares_.sums[late.edge]);
  }

 private:
  struct Late {
    EdgeId edge;
    Wide<Real> share;
  };

  EdgeAccumulator<Real> shares_;
  uint32_t first_half_edge_;
  Buffer<Late> late_;
};

/// Calls add_shares(face, shares) for `faces`, of a level or of the level above, and sums the
/// contributions in `made` [E].
template <class Real, class AddShares>
void accumulate_by_faces(const Topology& mesh, const IndexRange& faces, Vec3T<Real>* made, int threads,
                         const AddShares& add_shares) {
  if (faces.size() == 0) return;
  const EdgeAccumulator<Real> shares{made};
  const uint32_t parts = parts_of(faces.size(), threads);
  std::vector<DeferredEdgeAccumulator<Real>> late_of(parts, {shares, 0});
  for_each_part(parts, faces.size(), [&](uint32_t part, uint32_t first, uint32_t last) {
    DeferredEdgeAccumulator<Real> late(shares, faces[first]);
    const AddShares add = add_shares;  // a copy per thread stays in registers
    for (uint32_t i = first; i < last; ++i) {
      const FaceId f = faces[i];
      const uint32_t* twin = &mesh.twin[size_t{3} * f];
      if (late.is_early(std::min({twin[0], twin[1], twin[2]}))) [[unlikely]]
        add(f, late);
      else
        add(f, shares);
    }
    late_of[part] = std::move(late);
  });
  for (const DeferredEdgeAccumulator<Real>& late : late_of) late.end();
}

}  // namespace papilio
