#pragma once

#include "base/poller.h"
#include "papilio/mesh.h"

namespace papilio {

/// Removes slivers from a manifold surface: thin faces whose shortest edge or height is at most `distance`, and faces
/// whose edges are all at most that long. Collapses short edges, flips long edges of flat slivers, and removes flat
/// slivers at boundaries. No point of the surface moves by more than `distance`, or by more than a tenth of the mean
/// edge. Remaining vertices stay in place, and seams of attributes stay seams. Returns the mesh with edges; unchanged
/// if it has no slivers. O(F), and one operation per sliver.
[[nodiscard]] Mesh remove_slivers(Mesh mesh, double distance, const Poller& poller = {});

}  // namespace papilio
