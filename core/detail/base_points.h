#pragma once

#include "detail/collapse_sequence.h"
#include "papilio/mesh.h"

namespace papilio {

/// Returns a base with the attributes of the original, for its coder: a vertex on a seam has several points.
[[nodiscard]] TriangleMesh points_of_base(const BaseMesh& base, const Mesh& original);

}  // namespace papilio
