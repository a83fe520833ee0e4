#pragma once

#include <vector>

#include "mesh/displacement.h"
#include "mesh/split_plan.h"
#include "papilio/mesh.h"

namespace papilio {

/// Faces of the next level: each parent is followed by as many children as it has target edges plus one.
/// Sum over all faces, before anything is made.
[[nodiscard]] uint64_t count_children(const Topology& mesh, const SplitPlan& plan);

/// Splits every face by its target edges: none, it stays; one, two triangles; two, three, cut along the
/// shorter diagonal (equal ones: the one from the lower old vertex); three, four. Orientation is kept and no
/// T-junction arises.
///
/// `positions` [V + plan.count()] has the new vertices at its end; `attributes` are split along unless they are empty,
/// with `displaced` at the new vertices (split_points). The result's faces lie in their parents' order; its arrays
/// follow from the parents' by formula, in O(F + E), without a search. Edge kinds are inherited; edges inside a parent
/// are smooth.
[[nodiscard]] Topology split(const Topology& mesh, const SplitPlan& plan, const Buffer<Vec3f>& positions,
                             PointAttributes& attributes, const Displacements& displaced = {});

}  // namespace papilio
