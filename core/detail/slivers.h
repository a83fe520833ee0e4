#pragma once

#include "papilio/mesh.h"

namespace papilio {

/// Removes slivers from a manifold surface: thin faces whose shortest edge, or whose height, is at most `distance`, and
/// faces whose edges all are. Short edges are collapsed, long edges of flat slivers are flipped, and flat slivers at
/// boundaries go. No point of the surface moves by more than `distance`, nor by more than a tenth of the mean edge.
/// Vertices stay in place, and seams of attributes stay seams. The mesh is returned with its edges, as it was where
/// nothing was removed. O(F) and as many operations as there are slivers.
[[nodiscard]] Mesh remove_slivers(Mesh mesh, double distance);

}  // namespace papilio
