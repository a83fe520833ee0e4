#pragma once

#include "papilio/mesh.h"

namespace papilio {

/// Surface whose edges have one or two faces, wound alike, and whose vertices have one fan of faces each.
struct ManifoldSurface {
  Mesh mesh;            ///< with its edges
  uint32_t parted = 0;  ///< vertices that were parted
};

/// Builds the surface. A vertex with several fans becomes one vertex a fan, each moved by at most `distance` into its
/// own faces: edges that more than two faces share become boundaries. Throws `Error` bad_surface where that does not
/// part all of them, and what build_mesh() throws. O(F log F).
[[nodiscard]] ManifoldSurface manifold_surface(const TriangleMesh& triangles, double distance);

/// Throws `Error` bad_surface unless the mesh is manifold, perhaps with boundaries.
void require_manifold(const Mesh& mesh);

}  // namespace papilio
