#pragma once

#include "proto/edgebreaker/corner_mesh.h"
#include "proto/edgebreaker/poller.h"

namespace papilio::proto::edgebreaker {

/// Order in which values at vertices are written: the order in which depth-first walks reach the vertices.
struct VertexOrder {
  Buffer<uint32_t> corners;  ///< [vertices] the corner at which a walk reached each
  /// Indices in `corners`, ascending, of vertices that no parallelogram predicts: the opposite face is missing or has a
  /// vertex that comes later.
  Buffer<uint32_t> unpredicted;
};

/// Orders vertices depth first. `starts`: a corner of each face, in the order of `write_connectivity`. `poller` steps
/// once a face.
[[nodiscard]] VertexOrder order_vertices(const CornerMesh& mesh, const Buffer<uint32_t>& starts, Poller& poller);

/// Orders vertices by Draco's maximum prediction degree traversal: more vertices lie opposite to several faces whose
/// vertices came before. Returns the corner at which the walk reaches each vertex. [vertices]
[[nodiscard]] Buffer<uint32_t> order_by_prediction_degree(const CornerMesh& mesh, const Buffer<uint32_t>& starts,
                                                          Poller& poller);

}  // namespace papilio::proto::edgebreaker
