#pragma once

#include "proto/edgebreaker/corner_mesh.h"
#include "proto/edgebreaker/pace.h"

namespace papilio::proto::edgebreaker {

/// The order in which values at vertices are written: that in which walks, depth first, come to them. Mostly it is
/// across an edge from a face that they have been to.
struct VertexOrder {
  Buffer<uint32_t> corners;  ///< [vertices] the corner at which a walk came to each
  /// The places, ascending, of the vertices opposite to which there is no face, or one with vertices that come later.
  Buffer<uint32_t> alone;
};

/// `starts`: a corner of each face, in the order of `write_connectivity`. `pace` steps once a face.
[[nodiscard]] VertexOrder order_vertices(const CornerMesh& mesh, const Buffer<uint32_t>& starts, Pace& pace);

/// Orders vertices so that more of them lie opposite several faces whose vertices came before: Draco's maximum
/// prediction degree traversal. Returns the corner at which the walk comes to each vertex. [vertices]
[[nodiscard]] Buffer<uint32_t> order_by_prediction_degree(const CornerMesh& mesh, const Buffer<uint32_t>& starts,
                                                          Pace& pace);

}  // namespace papilio::proto::edgebreaker
