#pragma once

#include <cstdint>
#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// Finds the seams of a mesh's attributes: edges whose two faces have different points at an end, in ascending order.
/// The mesh must have its edges. Without attributes there are none. O(E).
[[nodiscard]] std::vector<uint32_t> seam_edges(const Mesh& mesh);

/// A mesh that is cut along its seams. Each vertex of it is one fan of faces, between seams, of one of the mesh's
/// vertices, so that values at vertices jump at seams alone.
struct CutSurface {
  /// Faces and half-edges are those of the mesh; seams are boundaries. Where a vertex of the mesh ends a curve or a
  /// seam, or several meet, the vertices cut from it are corners.
  Topology topology;
  Buffer<uint32_t> half_edge;  ///< [V] the lowest half-edge that leaves the vertex
};

/// Cuts a manifold mesh along its seams, as seam_edges() finds them. O(F).
[[nodiscard]] CutSurface cut_at_seams(const Mesh& mesh, const std::vector<uint32_t>& seams);

}  // namespace papilio
