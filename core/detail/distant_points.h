#pragma once

#include "base/poller.h"
#include "detail/original_surface.h"
#include "detail/residual_fit.h"

namespace papilio {

/// Bounds of reach_distant_points(), in the mesh's unit.
struct DistantBounds {
  double most = 0;         ///< distance beyond which a point is distant
  double sheet_reach = 0;  ///< as of find_folds()
};

/// Moves new vertices of the last level onto points of the original that are distant from the surface: vertices and
/// centres of faces. The correspondence gives thin tips and notches few new vertices or none, so the surface cuts them
/// off, and the nearest points of its own vertices do not show that. A vertex moves once at most, by a residual with
/// three parts if need be, and moves back if a face round it turns against the original.
/// O(F log F).
void reach_distant_points(ResidualFit& fit, const OriginalSurface& original, const DistantBounds& bounds,
                          const Poller& poller);

}  // namespace papilio
