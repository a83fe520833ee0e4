#pragma once

#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// A vertex to be inserted in the edge of a half-edge.
struct Insertion {
  uint32_t half_edge = none;
  double share = 0;  ///< of the edge from its origin to the vertex
  uint32_t vertex = none;
};

/// Finds T-junctions: boundary vertices within `distance` of a boundary edge, farther than that from both its ends, at
/// which a boundary edge of another face runs along it in the opposite direction. In the order of half-edges, then of
/// places along each; vertices of one edge are more than `distance` apart. At most as many as there are boundary edges.
/// O(n log n) with n boundary edges; bounded work.
[[nodiscard]] std::vector<Insertion> find_t_junctions(const Topology& mesh, const Buffer<Vec3f>& positions,
                                                      double distance);

}  // namespace papilio
