#pragma once

#include <cstdint>

#include "base/poller.h"
#include "detail/original_surface.h"
#include "detail/surface_tree.h"

namespace papilio {

/// Returns whether a face is turned against the original at its centre: against both its nearest face and its smooth
/// normal. Another sheet of a thin part may be nearer: a face is no fold if the original has a face of its orientation
/// within `reach`. O(log F).
[[nodiscard]] bool is_fold(const OriginalSurface& original, const TriangleCorners& face, double reach);

/// Folds of a surface.
struct Folds {
  uint32_t faces = 0;
  double area = 0;  ///< share of the surface's area
};

/// Finds the folds of a surface. O(F log F).
[[nodiscard]] Folds find_folds(const OriginalSurface& original, const SurfaceTree& surface, double reach,
                               const Poller& poller = {});

}  // namespace papilio
