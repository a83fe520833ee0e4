#pragma once

#include "mesh/displacement.h"
#include "papilio/options.h"

namespace papilio {

/// What the rules under the options' tension and w make of displacements at the vertices of a level, at the new
/// vertices of the plan's edges (ButterflyOfVectors); elsewhere not a number. The mesh may have further positions.
[[nodiscard]] Displacements split_displacements(const Displacements& at_vertices, const Mesh& mesh,
                                                const Options& options, const SplitPlan& plan);

}  // namespace papilio
