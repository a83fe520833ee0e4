#pragma once

#include "papilio/mesh.h"

namespace papilio {

/// Finds boundary vertices to weld, so that gaps between boundary edges of equal ends, but for `distance`, close.
///
/// Two boundary edges that run in opposite directions close, nearest first, if each end of one is within `distance` of
/// an end of the other. Their vertices become one, at the position of that with the lowest number. Edges do not close
/// where a face would lose a corner or turn over, where an edge would have two faces on one side, or where a vertex
/// would move by more than `distance`. Vertices that only touch stay apart. Returns [V] the vertex that each becomes,
/// or nothing if none is to be welded. O(n log n) with n boundary edges, and O(H) once a gap is found; bounded work.
[[nodiscard]] Buffer<uint32_t> weld_gaps(const Topology& mesh, const Buffer<Vec3f>& positions, double distance);

}  // namespace papilio
