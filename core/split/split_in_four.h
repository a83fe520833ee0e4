#pragma once

#include "mesh/four_children.h"
#include "mesh/part.h"
#include "papilio/mesh.h"

// One uniform level, by formula: every edge is split, every face becomes four.
//
// The children of face f are faces 4f to 4f + 3: child i < 3 keeps corner i, as its own corner i; child 3 lies in the
// middle, its corner i on edge i of f. The halves of edge e are edges 2e and 2e + 1, the half at its lower vertex
// first; its new vertex is V + e. The three edges inside f come after all halves, at 2E + 3f. split() gives an equal
// result if every edge is a target.

namespace papilio {

/// Returns the next level's connectivity, computed by at most `threads` threads. Kinds of edges are inherited; new
/// edges inside a face are smooth. O(F + E).
[[nodiscard]] Topology split_in_four(const Topology& mesh, int threads = 1);
/// Splits a part in four. Its faces must have a twin at each side, none across a curve. Vertices keep the numbers of
/// the whole level; faces and edges have those of the part. The sentinel face for all other faces also has four
/// children, without area, whose twins are within themselves.
[[nodiscard]] Topology split_part_in_four(const Topology& mesh, const Part& part, int threads = 1);
/// Returns split_in_four() without its edges (mesh.h), for a level that is not split again.
[[nodiscard]] Topology split_last_in_four(const Topology& mesh, int threads = 1);
/// Returns split_last_in_four() of split_in_four(), without the level between.
[[nodiscard]] Topology split_last_in_sixteen(const Topology& mesh, int threads = 1);

}  // namespace papilio
