#pragma once

#include "mesh/part.h"
#include "papilio/mesh.h"
#include "rules/features.h"

namespace papilio {

/// Computes the plain butterfly (butterfly.h) for the level below `parents` (split_in_four.h), four faces at once
/// (child_stencil.h). Writes the new vertices of all edges of the level to `made` [E]; with a part, those of the edges
/// between faces of split_part_in_four(). Results are bit-identical to butterfly(), and the level itself is not needed.
/// `features` are those of the parents, which are rings. Uses at most `threads` threads. O(F).
void butterfly_below(const Topology& parents, const Part* part, const Features& features, const Vec3f* positions,
                     Vec3f* made, int threads = 1);

}  // namespace papilio
