#pragma once

#include <vector>

#include "base/lazy_values.h"
#include "criteria/selection.h"
#include "mesh/part.h"
#include "mesh/split_plan.h"
#include "papilio/mesh.h"
#include "rules/features.h"

// The hierarchy of the uniform subdivision, held only where it is wanted.
//
// Level k holds some of the faces that k uniform levels would make, with the very numbers that the uniform mesh would
// give them but for the gaps. A face that may be split needs exact positions in the two rings of faces round it. So
// not only what is split gets children, but every face that shares a vertex with it ("support"): the two rings round a
// child of T lie inside the children of T's one ring, and the next level has what it needs in turn. A last level, below
// which no other comes, may leave the support out (refine_last_level).
//
// Nothing here depends on a view or on what is chosen: a level once made is read by any number of requests, each of
// which may use less of it than is held (level_choice.h). Numbers keep their order however much is held, and so does
// all that is made of them.

namespace papilio {

/// Bytes, at most, of a held face of a level, and of what is computed on it; without attributes.
inline constexpr uint64_t bytes_per_held_face = 160;

/// Numbers in the whole level of what a level holds of it.
struct WholeNumbers {
  Buffer<uint32_t> edge;                    ///< [E]
  Buffer<uint32_t> parent;                  ///< [F / 4] of the faces above
  uint32_t edge_count = 0, face_count = 0;  ///< of the whole level
};

struct HierarchyLevel {
  Mesh mesh;                 ///< faces held; where others of the level are missing, edges are EdgeKind::cut
  bool is_whole = false;     ///< all the level's faces are held, with the numbers of the uniform mesh
  Features features;         ///< of the vertices that are complete
  Buffer<uint8_t> complete;  ///< [V] whether all the level's faces at the vertex are held
  Buffer<uint32_t> parent;   ///< [F / 4] the face above of children 4i to 4i + 3, `none` of others; empty where it is i
  Buffer<uint32_t> child;  ///< [F of the level above] first of the face's four children here; empty as above. Of others
                           ///< `none`, or in a last level the four that stand for them
  Buffer<uint8_t> red;     ///< [F of the level above] whose children are held with the rings round them
  Buffer<uint32_t> shared;  ///< the half-edges at shared edges
  Trial trial;              ///< what splitting its edges would give, where tried
  Buffer<double> longest;   ///< [V] edges (view_culling.h); empty where no view asked
  Box box{};                ///< of the vertices
  int detail_levels = 0;    ///< levels from here on whose new vertices the coarse mesh's detail gives
  WholeNumbers in_whole;    ///< where there are any, and the level is not whole

  /// The face above, not of level 0.
  [[nodiscard]] uint32_t parent_of(uint32_t face) const { return parent.empty() ? face / 4 : parent[face / 4]; }
  /// The first child of a face of the level above that has children here.
  [[nodiscard]] uint32_t first_child_of(uint32_t above) const { return child.empty() ? 4 * above : child[above]; }
  /// Whether all of the level is held, and all of its edges were tried.
  [[nodiscard]] bool is_tried_whole() const {
    return is_whole && !trial.is_of_some && trial.made.size() == mesh.topology.edge_count();
  }
  /// Whether every face at the edge is held, and so are the rings round its ends, and all that its rule looks at.
  [[nodiscard]] bool is_complete(uint32_t edge) const;
  /// What it takes in memory.
  [[nodiscard]] uint64_t bytes() const;
};

/// Level 0: all of the mesh.
[[nodiscard]] HierarchyLevel coarsest_level(Mesh mesh);

/// The edges all of whose faces are children of red ones. [E]
[[nodiscard]] EdgeMarks edges_below_red(const HierarchyLevel& level);
/// The edges whose new vertex can be computed. [E]
[[nodiscard]] EdgeMarks complete_edges(const HierarchyLevel& level);

/// The faces that share a vertex with a marked one, themselves included. Marks [F].
[[nodiscard]] Buffer<uint8_t> with_neighbours(const Topology& mesh, const Buffer<uint8_t>& faces);

struct LevelBelow {
  HierarchyLevel level;
  /// The faces above that have children in the level, as a mesh of their own: the level is what split_in_four() makes
  /// of it. Empty where the level is whole: then it is all of the level above.
  Topology parents;
};

/// Makes the next level: the children of the faces marked `red` [F] and of all their neighbours. Every edge of these
/// must have been tried. Up to so many threads work on it.
[[nodiscard]] LevelBelow refine_level(const HierarchyLevel& level, Buffer<uint8_t> red, int threads = 1);

/// Makes all of the next level, with `red` [F] as refine_level() has it. The level must be whole, and all of its edges
/// tried.
[[nodiscard]] HierarchyLevel refine_whole_level(const HierarchyLevel& level, Buffer<uint8_t> red, int threads = 1);

/// Makes the next level where no other comes below it: it holds the children of the red faces and nothing else but four
/// faces that stand for all the others of the level (split_part_in_four). Its vertices are those of the whole level. So
/// nothing has to be cut, and `features` and `complete` are left out, which only a further level would need. Of a level
/// whose features are rings; `part`: what is red.
[[nodiscard]] HierarchyLevel refine_last_level(const HierarchyLevel& level, Buffer<uint8_t> red, const Part& part,
                                               int threads = 1);

}  // namespace papilio
