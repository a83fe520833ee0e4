#pragma once

#include "proto/edgebreaker/corner_mesh.h"

namespace papilio::proto::edgebreaker {

/// The order in which values at vertices are written: that in which a walk, depth first, comes to them.
struct VertexOrder {
  Array<uint32_t> corners;  ///< [vertices] the corner at which the walk came to each
  Array<uint32_t> place;    ///< [vertices] of each vertex in that order
};

/// `starts`: a corner of each face, in the order of `write_connectivity`.
[[nodiscard]] VertexOrder order_vertices(const CornerMesh& mesh, const Array<uint32_t>& starts);

}  // namespace papilio::proto::edgebreaker
