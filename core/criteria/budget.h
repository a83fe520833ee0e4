#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "mesh/region.h"
#include "papilio/mesh.h"

// Selection of the edges with the largest errors within a budget of faces.

namespace papilio {

struct WeighedEdge {
  float error;
  uint32_t faces;  ///< number of faces at the edge
};
/// Appends the region's edges with an error of at least `least`. `errors` [E]
void append_edges(const Topology& mesh, const Region& region, const Buffer<float>& errors, float least,
                  Buffer<WeighedEdge>& edges);

/// Returns the lowest threshold, at least `least`, at which splits keep to `budget` faces: of the present `faces`, each
/// edge with an error of at least the threshold adds as many as it has faces. Infinite if no edge fits. O(E).
[[nodiscard]] float threshold_within(std::span<const WeighedEdge> edges, float least, uint64_t faces, uint64_t budget);

}  // namespace papilio
