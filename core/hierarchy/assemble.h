#pragma once

#include <cstdint>
#include <span>

#include "hierarchy/level_choice.h"
#include "mesh/displacement.h"

namespace papilio {

/// Returns the number of faces of the mesh that assemble() makes of the levels and their split edges.
[[nodiscard]] uint64_t count_assembled(std::span<const LevelChoice> levels);

/// Assembles the mesh of the levels: faces with three split edges are replaced by their children; faces with one or two
/// are cut (transition.h). Each level below the first holds children of the faces marked red above. Faces are in the
/// order of their coarse faces. Vertices are those of the coarse mesh, then those of each level in the order of its
/// edges. Twins are found in one pass over the faces, without a search. Edges may be
/// left out (mesh.h). `displaced` [level]: see displaced_levels.h; empty if the coarse mesh has no displacements.
[[nodiscard]] Mesh assemble(std::span<const LevelChoice> levels, bool with_edges,
                            std::span<const Displacements> displaced);

}  // namespace papilio
