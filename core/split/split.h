#pragma once

#include <vector>

#include "mesh/displacement.h"
#include "mesh/marks.h"
#include "papilio/mesh.h"

namespace papilio {

/// Returns the number of faces of the next level before it is made: each parent has one child more than target edges.
[[nodiscard]] uint64_t count_children(const Topology& mesh, const Marks& targets);

/// Splits every face by its target edges: with none, it stays; with one, it becomes two triangles; with three, four.
/// With two, it becomes three, cut along the shorter diagonal (if equal: from the lower old vertex). Orientation is
/// kept and no T-junction arises.
///
/// `targets` [E]. `positions` has the new vertices after the old ones, in the order of their edges. `attributes` are
/// split along unless they are empty, with `displaced` at the new vertices (split_points). Faces of the result are in
/// the order of their parents. Its arrays are computed from those of the parents in O(F + E), without a search. Edge
/// kinds are inherited; edges inside a parent are smooth.
[[nodiscard]] Topology split(const Topology& mesh, const Marks& targets, const Buffer<Vec3f>& positions,
                             PointAttributes& attributes, const Displacements& displaced = {});

}  // namespace papilio
