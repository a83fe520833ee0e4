#pragma once

#include <cstdint>
#include <span>

#include "hierarchy/level_choice.h"
#include "mesh/displacement.h"

namespace papilio {

/// Faces of the mesh that the levels give with the edges that each has marked as split.
[[nodiscard]] uint64_t count_assembled(std::span<const LevelChoice> levels);

/// That mesh: faces with three split edges give way to their children, those with one or two are cut (transition.h).
/// Each level below the first is made of what the one above has marked red. Faces lie where their coarse face lies;
/// vertices are those of the coarse mesh, then those of each level in the order of its edges. Twins are found in one
/// pass over the faces, without a search. `most_cosine`: see transition.h. Edges may be left out (mesh.h).
/// `displaced`: of the levels (displaced_levels.h); empty where the coarse mesh has no displacements.
[[nodiscard]] Mesh assemble(std::span<const LevelChoice> levels, double most_cosine, bool with_edges,
                            std::span<const Displacements> displaced);

}  // namespace papilio
