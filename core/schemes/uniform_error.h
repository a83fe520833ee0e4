#pragma once

#include "papilio/mesh.h"

// Largest deviation of a uniform level. Most edges are skipped by the distance from new vertex to midpoint, an upper
// bound of the deviation.

namespace papilio {

/// Returns the largest deviation (deviation.h) of the mesh's edges, in the mesh's unit. The new vertices `made` [E]
/// must be in a `Buffer`. Uses at most `threads` threads. O(F).
[[nodiscard]] double largest_deviation(const Mesh& mesh, const Vec3f* made, int threads);

/// Returns the largest deviation of the level below `parents`, without its connectivity (child_stencil.h). `positions`
/// and `made` are of that level, whose edges must all be smooth.
[[nodiscard]] double largest_deviation_below(const Topology& parents, const Buffer<Vec3f>& positions, const Vec3f* made,
                                             int threads);

}  // namespace papilio
