#pragma once

#include <vector>

#include "base/lazy_values.h"
#include "criteria/selection.h"
#include "mesh/marks.h"
#include "mesh/part.h"
#include "papilio/mesh.h"
#include "rules/features.h"

// Hierarchy of the uniform subdivision, sparse: only required faces are held.
//
// Level k holds some of the faces that k uniform levels would make, numbered as in the uniform mesh except for gaps. A
// face that may be split needs exact positions in the two rings of faces round it. So children are made of split faces
// and of every face that shares a vertex with one ("support"). The two rings round a child of T lie inside the children
// of T's one ring, and so the next level is supported in turn. A last level, below which no other comes, may leave the
// support out (refine_last_level).
//
// There are three kinds of levels:
//
//                 whole      held in part           last (refine_last_level)
//   faces         all        children of `parent`s  children of red faces, then 4 sentinels for all others
//   vertices      all        those of the faces     those of the level above, then one on each of its edges
//   edges         all        those of the faces     those of the faces, then 5 of the sentinels
//   parent_of(f)  f / 4      `parent`[f / 4]        `parent`[f / 4], `none` for the sentinels
//   child of f    4f         `child`[f] or `none`   `child`[f], the first sentinel where there is none
//   left out      nothing    edges are cut, see     features and `complete`
//                            `complete`
//
// Nothing here depends on a view or a choice. A level is immutable once made: any number of requests may read it, and
// each may use only part of it (level_choice.h). The order of numbers, and of all derived data, does not depend on how
// much is held.

namespace papilio {

/// Upper bound of the bytes of a held face of a level and of its computed values, without attributes.
inline constexpr uint64_t bytes_per_held_face = 160;

/// Numbers of a level's elements in the whole level.
struct WholeNumbers {
  Buffer<uint32_t> edge;                    ///< [E]
  Buffer<uint32_t> parent;                  ///< [F / 4] number of the face above
  uint32_t edge_count = 0, face_count = 0;  ///< counts of the whole level
};

struct HierarchyLevel {
  Mesh mesh;                 ///< faces held; where others of the level are missing, edges are EdgeKind::cut
  bool is_whole = false;     ///< whether all the level's faces are held, numbered as in the uniform mesh
  Features features;         ///< features of the complete vertices
  Buffer<uint8_t> complete;  ///< [V] whether all the level's faces at the vertex are held
  Buffer<uint32_t> parent;  ///< [F / 4] the face above children 4i to 4i + 3, `none` for sentinels; empty where it is i
  Buffer<uint32_t> child;   ///< [F of the level above] first of the face's four children; empty where it is 4f. For
                            ///< others `none`, or in a last level the first sentinel
  Buffer<uint8_t> red;      ///< [F of the level above] whether its children are held with the rings round them
  Buffer<uint32_t> shared;  ///< half-edges at shared edges
  Trial trial;              ///< new vertices of its edges, where tried
  Buffer<double> longest;   ///< [V] longest edges (view_culling.h); may be empty without a view
  Box box{};                ///< bounding box of the vertices
  double most_cosine = 1;   ///< upper bound for transition faces (transition.h), equal on all levels
  int detail_levels = 0;    ///< number of levels from here on with new vertices from the coarse mesh's detail
  WholeNumbers in_whole;    ///< only with `detail_levels`, if the level is not whole

  /// Returns the face above; not for level 0.
  [[nodiscard]] uint32_t parent_of(FaceId face) const { return parent.empty() ? face / 4 : parent[face / 4]; }
  /// Returns the first child of a face of the level above that has children here.
  [[nodiscard]] uint32_t first_child_of(uint32_t above) const { return child.empty() ? 4 * above : child[above]; }
  /// Returns whether all faces at the edge, the rings round its ends and all other inputs of its rule are held.
  [[nodiscard]] bool is_complete(EdgeId edge) const;
  /// Returns the memory used.
  [[nodiscard]] uint64_t bytes() const;
};

/// Returns level 0, which holds all of the mesh.
[[nodiscard]] HierarchyLevel coarsest_level(Mesh mesh);

/// Marks the edges all of whose faces are children of red ones. [E]
[[nodiscard]] Marks edges_below_red(const HierarchyLevel& level);
/// Marks the edges whose new vertex can be computed. [E]
[[nodiscard]] Marks complete_edges(const HierarchyLevel& level);

/// Marks the faces that share a vertex with a marked one, including the marked ones. Marks [F].
[[nodiscard]] Buffer<uint8_t> with_neighbours(const Topology& mesh, const Buffer<uint8_t>& faces);

struct LevelBelow {
  HierarchyLevel level;
  /// Faces above that have children in the level, as a mesh of their own: split_in_four() of it gives the level. Empty
  /// if the level is whole: then it is all of the level above.
  Topology parents;
};

/// Makes the next level: the children of the faces marked `red` [F] and of all their neighbours. Every edge of these
/// faces must have been tried. Uses at most `threads` threads.
[[nodiscard]] LevelBelow refine_level(const HierarchyLevel& level, Buffer<uint8_t> red, int threads = 1);

/// Makes the last level: it holds the children of the red faces, and four sentinel faces that stand for all
/// others (split_part_in_four). Its vertices are those of the whole level. So nothing is cut. `features` and
/// `complete` are left out, as only a further level would need them. The features of `level` must be rings;
/// `part` holds the red faces.
[[nodiscard]] HierarchyLevel refine_last_level(const HierarchyLevel& level, Buffer<uint8_t> red, const Part& part,
                                               int threads = 1);

}  // namespace papilio
