#pragma once

#include <cstdint>
#include <vector>

#include "base/poller.h"
#include "detail/base_lift.h"
#include "detail/detail_level.h"
#include "detail/original_surface.h"
#include "detail/residuals.h"

namespace papilio {

/// Levels with the residuals that put each vertex onto the original.
struct PlacedLevels {
  std::vector<DetailLevel> levels;   ///< levels that are split
  std::vector<Residuals> residuals;  ///< residuals of each level
  Topology last;                     ///< connectivity of the last level
};

/// Quantization steps of the levels.
struct StepSchedule {
  float last = 0;      ///< step of the last level
  float ratio = 0.8F;  ///< step of a level, as a share of the next finer one's
  [[nodiscard]] float of(int level, int levels) const;
};

/// Chooses residuals level by level from decoded positions, so that errors do not add up. `levels` must not exceed the
/// lifted ones.
/// - A new vertex moves to the intersection of the line along its normal with the original. Walks over the surface find
///   it, from the vertex's neighbours and from its lifted place. Without one nearby, the vertex moves to its lifted
///   place, by a residual of three parts.
/// - On a curve, it moves to the intersection of the original's curve with the plane across its edge.
/// - Where faces turn over, their new vertices move between their neighbours as far as that turns the faces back.
[[nodiscard]] PlacedLevels place_on_original(const OriginalSurface& original, const LiftedBase& base, int levels,
                                             const StepSchedule& steps, const Poller& poller);

}  // namespace papilio
