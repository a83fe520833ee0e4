#pragma once

#include <vector>

#include "detail/collapse_sequence.h"
#include "detail/original_surface.h"
#include "papilio/detail.h"
#include "papilio/mesh.h"

namespace papilio {

/// Returns a base with the attributes of the original, for its coder: a vertex on a seam has several points.
[[nodiscard]] TriangleMesh points_of_base(const BaseMesh& base, const Mesh& original);

/// Returns [V] the places to which a coder of points_of_base() moved the vertices of the base.
[[nodiscard]] Buffer<Vec3f> moved_vertices(const BaseMesh& base, const Mesh& original, const CodedBase& coded);

/// Returns, for each vertex of the base, the original's unit normal; zero where the vertex must not slide along the
/// surface, on curves. Empty for a base with attributes: none of its vertices must.
[[nodiscard]] std::vector<Vec3d> sliding_normals(const BaseMesh& base, const OriginalSurface& original);

}  // namespace papilio
