#pragma once

#include "papilio/mesh.h"

namespace papilio {

/// Surface whose edges have one face, or two of consistent orientation, and whose vertices have one fan of faces.
struct ManifoldSurface {
  Mesh mesh;            ///< mesh with edges
  uint32_t parted = 0;  ///< number of vertices that were separated
};

/// Builds the surface. A vertex with several fans becomes one vertex a fan, each moved by at most `distance` into its
/// faces. So edges of more than two faces, and edges of two faces back to back, become boundaries. Throws `Error`
/// bad_surface if some cannot be separated, and errors of build_mesh(). O(F log F).
[[nodiscard]] ManifoldSurface manifold_surface(const TriangleMesh& triangles, double distance);

/// Throws `Error` bad_surface unless the mesh is manifold, perhaps with boundaries.
void require_manifold(const Mesh& mesh);

}  // namespace papilio
