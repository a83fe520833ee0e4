#pragma once

#include "detail/collapse_sequence.h"
#include "papilio/mesh.h"

namespace papilio {

/// Returns a base as its coder takes it, with the attributes of the original: a vertex at seams is several points.
[[nodiscard]] TriangleMesh points_of_base(const BaseMesh& base, const Mesh& original);

}  // namespace papilio
