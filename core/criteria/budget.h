#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "mesh/region.h"
#include "papilio/mesh.h"

// Which edges a budget of faces leaves: those with the largest errors.

namespace papilio {

struct WeighedEdge {
  float error;
  uint32_t faces;  ///< how many faces there are at the edge
};
/// Appends the region's edges whose error [E] is `least` or more.
void append_edges(const Topology& mesh, const Region& region, const Buffer<float>& errors, float least,
                  Buffer<WeighedEdge>& edges);

/// The least threshold, not below `least`, at which no more than `budget` faces come of the `faces` that are there
/// already: each edge with an error of at least the threshold adds as many as it has faces. Infinite when nothing
/// fits. O(E).
[[nodiscard]] float threshold_within(std::span<const WeighedEdge> edges, float least, uint64_t faces, uint64_t budget);

}  // namespace papilio
