#pragma once

#include <vector>

#include "mesh/split_plan.h"
#include "papilio/mesh.h"

namespace papilio {

/// Part of a mesh, so that work on it costs in proportion to the part.
struct Region {
  Buffer<uint32_t> faces;  ///< in ascending order
  EdgeMarks has_edge;      ///< [E] marks its edges: all faces at each of them are among `faces`
  bool has_curves = true;  ///< false only if none of its edges is on one

  /// Its edges in ascending order, found anew at each call.
  [[nodiscard]] Buffer<uint32_t> edges() const;
};

/// All of the mesh.
[[nodiscard]] Region whole_region(const Topology& mesh);

/// Keeps of a list what `is_wanted`, in its order. Nobody can guess which those are: so without branches.
template <class IsWanted>
void keep_if(Buffer<uint32_t>& numbers, const IsWanted& is_wanted) {
  size_t kept = 0;
  for (uint32_t number : numbers) {
    numbers[kept] = number;
    kept += is_wanted(number) ? 1 : 0;
  }
  numbers.resize(kept);
}

/// The numbers of what is marked, in ascending order. Marks are 0 or 1.
[[nodiscard]] Buffer<uint32_t> marked(const Buffer<uint8_t>& marks);

/// Marks what the half-edges of some faces have in `of` [H], numbers below `count`: their corners or edges.
[[nodiscard]] Buffer<uint8_t> used_by_faces(const Buffer<uint32_t>& faces, const Buffer<uint32_t>& of, uint32_t count);

/// The half-edges at shared edges, in ascending order.
[[nodiscard]] Buffer<uint32_t> shared_half_edges(const Topology& mesh);

}  // namespace papilio
