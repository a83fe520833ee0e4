#pragma once

#include "criteria/selection.h"
#include "hierarchy/progress.h"
#include "mesh/displacement.h"
#include "papilio/refine.h"

namespace papilio {

/// Splits the target edges of `mesh`, and its faces by their patterns; `made` [plan.count()] are the new vertices. Old
/// vertices keep their numbers and their positions to the bit. `displaced`: displacements at the edges.
[[nodiscard]] Mesh split_mesh(Mesh mesh, const SplitPlan& plan, const Buffer<Vec3f>& made,
                              const Displacements& displaced = {});

/// Refines by the paper's scheme: each level works on the mesh that the level before left, transition faces included.
[[nodiscard]] Result refine_in_place(Mesh coarse, const Options& options, const Selection& selection,
                                     const Progress& progress);

}  // namespace papilio
