#pragma once

#include <span>
#include <vector>

#include "hierarchy/level_choice.h"
#include "mesh/displacement.h"
#include "papilio/options.h"

namespace papilio {

/// Returns [level] the coarse mesh's displacements at the new vertices of the level's edges (split_displacements.h),
/// and the values of its detail (add_values_of_detail()). Empty if the mesh has neither. No level may be the result of
/// refine_last_level(). O(held faces) for each displacement.
[[nodiscard]] std::vector<Displacements> displacements_of(std::span<const LevelChoice> levels, const Options& options);

}  // namespace papilio
