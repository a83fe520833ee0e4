#pragma once

#include <span>

#include "papilio/mesh.h"

namespace papilio {

/// Returns the step of the grid on which Draco has placed positions, in their unit, or 0 where they are on none. The
/// longest side of their box has as many steps as Draco's encoder gives it, 2^b - 1 with b from 8 to 16, or as Papilio
/// does, whose grid is 1.25 times as long. Few values, or values that a coarser grid has too, as those of a model with
/// round measures, are no sign of a grid. O(positions).
[[nodiscard]] double grid_step(std::span<const Vec3f> positions);

}  // namespace papilio
