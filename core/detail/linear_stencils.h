#pragma once

#include <cstdint>
#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// Modified Butterfly scheme of one level as a sparse matrix: the new vertex of edge e is the weighted sum of vertices
/// `vertex[first[e]]` to `vertex[first[e + 1] - 1]`.
struct LinearStencils {
  Buffer<uint32_t> first;  ///< [E + 1]
  Buffer<uint32_t> vertex;
  Buffer<float> weight;
};

/// Returns the stencils of a manifold level with edges and curves. Weights: rules/stencil.h; at vertices of more than
/// 256 faces, of the middle of an edge.
[[nodiscard]] LinearStencils linear_stencils(const Topology& level);

}  // namespace papilio
