#pragma once

#include "proto/edgebreaker/corner_mesh.h"

namespace papilio::proto::edgebreaker {

/// Surface of a mesh in Draco's bitstream: an orientable manifold, in which each fan of faces has a vertex of its own.
struct Surface {
  CornerMesh mesh;
  Buffer<uint32_t> vertex{};  ///< [vertices of `mesh`] vertex of the original mesh; empty: equal indices

  /// Returns the vertex of the original mesh at vertex `v` of the surface.
  [[nodiscard]] uint32_t mesh_vertex(uint32_t v) const { return vertex.empty() ? v : vertex[v]; }
};

/// Cuts a mesh where it is not manifold: at vertices with several fans and at edges with more than two faces. As in
/// libdraco, two faces with the same three vertices are not connected. O(F + B log B) for B boundary edges.
[[nodiscard]] Surface manifold_surface(const Topology& mesh);

}  // namespace papilio::proto::edgebreaker
