#pragma once

#include "mesh/displacement.h"
#include "papilio/options.h"

namespace papilio {

/// Splits displacements at the vertices of a level by the rules under the options' tension and w
/// (ButterflyOfVectors). Returns values at the new vertices of the `complete` edges [E], and NaN elsewhere. The mesh
/// may have further positions.
[[nodiscard]] Displacements split_displacements(const Displacements& at_vertices, const Mesh& mesh,
                                                const Options& options, const Marks& complete);

}  // namespace papilio
