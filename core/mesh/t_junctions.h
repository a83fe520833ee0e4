#pragma once

#include <vector>

#include "base/ids.h"
#include "papilio/mesh.h"

namespace papilio {

/// Vertex to be inserted in the edge of a half-edge.
struct Insertion {
  uint32_t half_edge = none;
  double share = 0;  ///< place along the edge: 0 at the origin, 1 at the tip
  VertexId vertex = none;
};

/// Finds T-junctions: boundary vertices within `distance` of a boundary edge, but farther from both its ends, at which
/// a boundary edge of another face runs along it in the opposite direction. Ordered by half-edge, then by place along
/// it; vertices of one edge are more than `distance` apart. About as many as boundary edges at most. O(n log n) with n
/// boundary edges; bounded work.
[[nodiscard]] std::vector<Insertion> find_t_junctions(const Topology& mesh, const Buffer<Vec3f>& positions,
                                                      double distance);

}  // namespace papilio
