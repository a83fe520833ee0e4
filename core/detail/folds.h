#pragma once

#include <cstdint>

#include "detail/original_surface.h"
#include "detail/surface_tree.h"

namespace papilio {

/// Counts the faces of a surface that are turned against the original at their centres: against both its nearest face
/// and its smooth normal. Another sheet of a thin part may be nearer: a face is not counted if the original has a face
/// of its orientation within `reach`. O(F log F).
[[nodiscard]] uint32_t count_folds(const OriginalSurface& original, const SurfaceTree& surface, double reach);

}  // namespace papilio
