#pragma once

#include <cstdint>

#include "detail/original_surface.h"
#include "detail/surface_tree.h"

namespace papilio {

/// Counts the faces of a surface that are turned against the original where their centres lie: against its face there
/// and its smooth normal. Another sheet of a thin part may be nearer: none is counted where faces of the original
/// within `reach` are turned as it is. O(F log F).
[[nodiscard]] uint32_t count_folds(const OriginalSurface& original, const SurfaceTree& surface, double reach);

}  // namespace papilio
