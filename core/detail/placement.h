#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "detail/base_lift.h"
#include "detail/detail_level.h"
#include "detail/original_surface.h"
#include "detail/residuals.h"

namespace papilio {

/// Levels with the residuals that put each vertex onto the original.
struct PlacedLevels {
  std::vector<DetailLevel> levels;   ///< those that are split
  std::vector<Residuals> residuals;  ///< of each
  Topology last;                     ///< of the last level
};

/// Steps of the levels: that of the last one, and how much smaller each coarser one's is.
struct StepSchedule {
  float last = 0;
  float ratio = 0.8F;
  [[nodiscard]] float of(int level, int levels) const;
};

/// Chooses residuals level by level from decoded positions, so that errors do not add up. A new vertex goes where the
/// line along its normal meets the original, found by walks over the surface from the vertex's neighbours and from the
/// place that its parameters are lifted to. Where there is no such place near, it goes to that place
/// itself, by a residual of three parts. Where faces turn over, their new vertices move between their neighbours as far
/// as that turns them back. On curves a new vertex goes where the original's curve meets the plane across its edge. At
/// most as many levels as were lifted.
[[nodiscard]] PlacedLevels place_on_original(const OriginalSurface& original, const LiftedBase& base, int levels,
                                             const StepSchedule& steps, const std::function<void()>& poll);

}  // namespace papilio
