#pragma once

#include <span>

#include "hierarchy/level_choice.h"

namespace papilio {

/// Returns the largest deviation left in the result of the levels with their split edges.
[[nodiscard]] ErrorLeft error_left(std::span<const LevelChoice> levels, const Selection& selection);

}  // namespace papilio
