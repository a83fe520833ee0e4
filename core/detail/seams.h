#pragma once

#include <cstdint>
#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// Finds the seams of a mesh's attributes, in ascending order: edges whose two faces have different points at an end.
/// The mesh must have edges; without attributes it has no seams. O(E).
[[nodiscard]] std::vector<uint32_t> seam_edges(const Mesh& mesh);

/// Mesh cut along its seams. Each of its vertices is one fan of faces between seams, so that values at vertices jump at
/// seams only.
struct CutSurface {
  /// Connectivity with the mesh's faces and half-edges; seams are boundaries. Vertices cut from an end of a curve or a
  /// seam, or from a vertex where several meet, are corners.
  Topology topology;
  Buffer<uint32_t> half_edge;  ///< [V] lowest half-edge that leaves the vertex
};

/// Cuts a manifold mesh along its seam_edges(). O(F).
[[nodiscard]] CutSurface cut_at_seams(const Mesh& mesh, const std::vector<uint32_t>& seams);

}  // namespace papilio
