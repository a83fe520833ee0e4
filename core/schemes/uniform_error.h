#pragma once

#include "papilio/mesh.h"

// How far the surface moves at most where a uniform level splits it. Most edges are seen to matter less than another by
// how far their new vertex is from the midpoint, which is on the surface.

namespace papilio {

/// The largest deviation (deviation.h) of the mesh's edges, whose new vertices `made` [E] are an `Buffer`'s. In the
/// mesh's unit. Up to so many threads work on it. O(F).
[[nodiscard]] double largest_deviation(const Mesh& mesh, const Vec3f* made, int threads);

/// The same of the level below `parents`, by families (child_stencil.h): that level itself is not needed. `positions`
/// of its vertices. All of its edges must be smooth.
[[nodiscard]] double largest_deviation_below(const Topology& parents, const Buffer<Vec3f>& positions, const Vec3f* made,
                                             int threads);

}  // namespace papilio
