#pragma once

#include <vector>

#include "detail/original_surface.h"
#include "papilio/mesh.h"

namespace papilio {

/// Multiplies the vertices' weights [V] (none: 1) where a surface is farther from the original than on average, and
/// round there, so that a simplification by them keeps more.
void weigh_errors(const OriginalSurface& original, TriangleMesh surface, std::vector<float>& weights);

}  // namespace papilio
