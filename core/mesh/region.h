#pragma once

#include "mesh/marks.h"
#include "papilio/mesh.h"

namespace papilio {

/// Active region of a mesh: the cost of work on it is proportional to its size.
struct Region {
  Buffer<uint32_t> faces;  ///< numbers in ascending order
  Marks has_edge;          ///< [E] marks its edges: edges whose faces are all in `faces`

  /// Returns its edges in ascending order. Not cached.
  [[nodiscard]] Buffer<uint32_t> edges() const;
};

/// Returns the region of all faces.
[[nodiscard]] Region whole_region(const Topology& mesh);

/// Returns the half-edges at shared edges, in ascending order.
[[nodiscard]] Buffer<uint32_t> shared_half_edges(const Topology& mesh);

}  // namespace papilio
