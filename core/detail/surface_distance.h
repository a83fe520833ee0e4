#pragma once

#include <cstdint>

#include "base/poller.h"
#include "detail/surface_tree.h"

namespace papilio {

/// Distances between two surfaces, from samples of each.
struct SurfaceDistance {
  double rms = 0;      ///< root mean square, the larger of both directions
  double largest = 0;  ///< largest distance of either direction
};

/// Measures from `samples` points of each surface, spread evenly by area. Deterministic. O(samples log F).
[[nodiscard]] SurfaceDistance surface_distance(const SurfaceTree& a, const SurfaceTree& b, uint32_t samples,
                                               const Poller& poller = {});

/// Returns the largest distance from the vertices of each surface to the other one. (Samples miss thin spikes.)
/// O(V log F).
[[nodiscard]] double vertex_distance(const SurfaceTree& a, const SurfaceTree& b, const Poller& poller = {});

}  // namespace papilio
