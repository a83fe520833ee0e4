#pragma once

#include <span>
#include <vector>

#include "hierarchy/level_choice.h"
#include "mesh/displacement.h"
#include "papilio/options.h"

namespace papilio {

/// For each level, what the coarse mesh's displacements are at the new vertices of its edges [level], as the rules make
/// it (split_displacements.h), and the texture coordinates that its detail gives; empty where the mesh has neither.
/// None of the levels may be one of refine_last_level(). O(faces held) for each displacement.
[[nodiscard]] std::vector<Displacements> displacements_of(std::span<const LevelChoice> levels, const Options& options);

}  // namespace papilio
