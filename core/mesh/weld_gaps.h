#pragma once

#include "papilio/mesh.h"

namespace papilio {

/// Finds boundary vertices to weld, so that gaps between boundary edges whose ends are within `distance` close.
///
/// Two boundary edges in opposite directions close, nearest first, if each end of one is within `distance` of an end of
/// the other. Their vertices are welded at the position of the lowest-numbered one. Edges do not close if a face would
/// lose a corner or turn over, if an edge would have two faces on one side, or if a vertex would move by more than
/// `distance`. Vertices that only touch stay separate. Returns [V] the vertex that each is welded to, or an empty
/// buffer if there is none to weld. O(n log n) with n boundary edges, and O(H) once a gap is found; bounded work.
[[nodiscard]] Buffer<uint32_t> weld_gaps(const Topology& mesh, const Buffer<Vec3f>& positions, double distance);

}  // namespace papilio
