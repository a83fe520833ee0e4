#pragma once

#include "mesh/four_children.h"
#include "mesh/part.h"
#include "papilio/mesh.h"

// One uniform level, by formula: every edge is split, every face becomes four.
//
// The children of face f are faces 4f to 4f + 3: child i < 3 keeps corner i, as its own corner i; child 3 lies in the
// middle, its corner i on edge i of f. The halves of edge e are edges 2e and 2e + 1, the half at its lower vertex
// first; its new vertex is V + e. The three edges inside f come after all of those, at 2E + 3f. split() makes the same
// of a plan that splits everything.

namespace papilio {

/// The next level's connectivity, made by up to so many threads. Kinds of edges are inherited; new edges inside a face
/// are smooth. O(F + E).
[[nodiscard]] Topology split_in_four(const Topology& mesh, int threads = 1);
/// The same of a part, whose faces have a twin at each side, none across a curve: vertices have the same numbers, faces
/// and edges those of the part. What stands for all other faces has four children, too, without area: their twins lie
/// in themselves.
[[nodiscard]] Topology split_part_in_four(const Topology& mesh, const Part& part, int threads = 1);
/// The same without its edges (mesh.h): for a level that is not split again.
[[nodiscard]] Topology split_last_in_four(const Topology& mesh, int threads = 1);
/// Two levels at once: split_last_in_four of split_in_four, without the level between.
[[nodiscard]] Topology split_last_in_sixteen(const Topology& mesh, int threads = 1);

}  // namespace papilio
