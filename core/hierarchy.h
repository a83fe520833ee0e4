#pragma once

#include <vector>

#include "mesh.h"
#include "selection.h"
#include "split_plan.h"

// The hierarchy of the uniform subdivision, held only where it is wanted.
//
// Level k holds some of the faces that k uniform levels would make, with the very numbers that the uniform mesh would
// give them but for the gaps. A face that may be split needs exact positions in the two rings of faces round it. So
// not only what is split gets children, but every face that shares a vertex with it ("support"): the two rings round a
// child of T lie inside the children of T's one ring, and the next level has what it needs in turn.

namespace papilio {

struct HierarchyLevel {
  Mesh mesh;                       ///< faces held; where others of the level are missing, edges are EdgeKind::cut
  std::vector<uint8_t> complete;   ///< [V] whether all the level's faces at the vertex are held
  std::vector<uint8_t> candidate;  ///< [F] whether the face may be shown: all at level 0, then children of red faces
  std::vector<uint32_t> from;      ///< [V] a vertex of the level above, or its vertex count plus the edge split
  std::vector<uint32_t> parent;    ///< [F / 4] the face above of children 4i to 4i + 3; empty at level 0
  std::vector<uint32_t> child;     ///< [F] first of the face's four children in the level below; `none`
  Trial trial{{}, SplitPlan({}), {}};  ///< what splitting its edges would give
  /// [E] how much the edge wants to be split: its own error, or the error of what lies below and needs it split; minus
  /// infinity where nothing wants it.
  std::vector<float> error;
  EdgeMarks split;  ///< [E] what is split for the result

  /// Whether every face at the edge is held, and so are the rings round its ends.
  [[nodiscard]] bool is_complete(uint32_t edge) const;
};

/// Level 0: all of the mesh.
[[nodiscard]] HierarchyLevel coarsest_level(Mesh mesh);

/// The edges all of whose faces may be shown: the only ones that may be split for the result. [E]
[[nodiscard]] EdgeMarks edges_of_candidates(const HierarchyLevel& level);
/// The edges whose new vertex can be computed. [E]
[[nodiscard]] EdgeMarks complete_edges(const HierarchyLevel& level);

/// The faces that share a vertex with a marked one, themselves included. Marks [F].
[[nodiscard]] std::vector<uint8_t> with_neighbours(const Topology& mesh, const std::vector<uint8_t>& faces);

/// Makes the next level: the children of the faces marked `red` (candidates there) and of all their neighbours. Every
/// edge of these must have been tried. Sets `level.child`.
[[nodiscard]] HierarchyLevel refine_level(HierarchyLevel& level, const std::vector<uint8_t>& red);

}  // namespace papilio
