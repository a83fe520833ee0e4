#pragma once

#include <span>

#include "hierarchy/level_choice.h"

namespace papilio {

/// The largest deviation left in the mesh that the levels give with the edges that each has marked as split.
[[nodiscard]] ErrorLeft error_left(std::span<const LevelChoice> levels, const Selection& selection);

}  // namespace papilio
