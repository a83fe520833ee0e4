#pragma once

#include <span>

#include "base/ids.h"
#include "papilio/mesh.h"

namespace papilio {

/// Half-edges that leave each vertex, in ascending order.
class VertexSpokes {
 public:
  /// Sorts half-edges by origin. O(H).
  explicit VertexSpokes(const Topology& mesh)
      : starts_(size_t{mesh.vertex_count} + 1, 0), half_edges_(mesh.half_edge_count()) {
    for (const VertexId v : mesh.origin) ++starts_[v + 1];
    for (VertexId v = 0; v < mesh.vertex_count; ++v) starts_[v + 1] += starts_[v];
    Buffer<uint32_t> next = starts_;
    for (HalfEdgeId h = 0; h < mesh.half_edge_count(); ++h) half_edges_[next[mesh.origin[h]]++] = h;
  }

  [[nodiscard]] std::span<const uint32_t> of(VertexId vertex) const {
    return {half_edges_.data() + starts_[vertex], half_edges_.data() + starts_[vertex + 1]};
  }

 private:
  Buffer<uint32_t> starts_;      ///< [V + 1]
  Buffer<uint32_t> half_edges_;  ///< [H]
};

}  // namespace papilio
