#pragma once

#include "proto/edgebreaker/corner_mesh.h"

namespace papilio::proto::edgebreaker {

/// The surface of a mesh as Draco's bitstream describes it: an orientable manifold, so each fan of faces has a vertex
/// of its own.
struct Surface {
  CornerMesh mesh;
  Array<uint32_t> vertex{};  ///< [vertices of `mesh`] the mesh's vertex at each; empty: the same numbers

  [[nodiscard]] uint32_t mesh_vertex(uint32_t v) const { return vertex.empty() ? v : vertex[v]; }
};

/// Takes the surface apart where it is not manifold: at vertices with several fans, and at edges of three faces or
/// more. As in libdraco, two faces with the same three vertices are not connected. O(F + B log B) for B boundary edges.
[[nodiscard]] Surface manifold_surface(const Topology& mesh);

}  // namespace papilio::proto::edgebreaker
