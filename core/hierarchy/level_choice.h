#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "criteria/view_culling.h"
#include "hierarchy/hierarchy.h"
#include "mesh/region.h"

namespace papilio {

/// Choice of one request on a level. Its region is the faces that it may show: all at level 0; below, the children of
/// the faces that it explored. The region is often much smaller than the level. Arrays as long as the level's are valid
/// only in the region.
struct LevelChoice {
  std::shared_ptr<const HierarchyLevel> level;
  Region region;     ///< only its edges may be split
  EdgesShown shown;  ///< edges of the region that the view shows
  /// [E] split priority: the edge's own error, or the error of an edge below that requires its split. Minus infinity if
  /// neither. Empty unless errors decide.
  Buffer<float> error;
  Buffer<uint32_t> candidates;   ///< edges with at least the lowest threshold's error; without errors, all selected
  Marks split;                   ///< [E] edges split in the result
  Buffer<uint32_t> split_edges;  ///< `split` as a list
  Buffer<uint8_t> transitions;   ///< [F] judgements of partly split faces (transition.h); may be empty
  Buffer<uint8_t> red;           ///< [F] faces whose children are the next choice's region; empty if there is none
  Buffer<uint32_t> at_outline;   ///< red faces that were not divided when marked (outline.h)

  /// Returns the mask of split edges: bit i is set if edge i of the face is split.
  [[nodiscard]] unsigned split_mask(FaceId face) const {
    const uint32_t* edge = &level->mesh.topology.edge[size_t{3} * face];
    return split[edge[0]] | split[edge[1]] << 1U | split[edge[2]] << 2U;
  }
  void split_edge(EdgeId edge) {
    if (split[edge] != 0) return;
    split[edge] = 1;
    split_edges.push_back(edge);
  }
  void divide(FaceId face) {
    for (HalfEdgeId h = 3 * face; h < 3 * face + 3; ++h) split_edge(level->mesh.topology.edge[h]);
  }
  /// Splits `edges`, no edge twice. No edge may be split yet.
  void split_first(Buffer<uint32_t> edges) {
    for (EdgeId e : edges) split[e] = 1;
    split_edges = std::move(edges);
  }
  void split_nothing() {
    for (EdgeId e : split_edges) split[e] = 0;
    split_edges.clear();
  }
  /// Returns the sum of the numbers of faces at the split edges. Edges of the region have all their faces in it.
  [[nodiscard]] uint64_t count_faces_of_split() const;
  /// Calls `visit(parent, edges)` for each face of the level above whose children are in the region, with the 12 edges
  /// of its children's half-edges. The region must be below level 0.
  template <class Visit>
  void visit_parents(const Visit& visit) const {
    for (size_t i = 0; i < region.faces.size(); i += 4) {
      const FaceId f = region.faces[i];
      visit(level->parent_of(f), &level->mesh.topology.edge[size_t{3} * f]);
    }
  }
  /// Returns whether an edge is split among the children of a face of the level above; they must be in the region.
  [[nodiscard]] bool splits_below(uint32_t parent) const {
    const uint32_t* edge = &level->mesh.topology.edge[size_t{3} * level->first_child_of(parent)];
    return std::any_of(edge, edge + 12, [&](EdgeId e) { return split[e] != 0; });
  }
  /// Returns whether all the face's edges may be split.
  [[nodiscard]] bool may_divide(FaceId face) const {
    const uint32_t* edge = &level->mesh.topology.edge[size_t{3} * face];
    return (region.has_edge[edge[0]] & region.has_edge[edge[1]] & region.has_edge[edge[2]]) != 0;
  }
  /// Returns the faces whose children the next level holds for this request: red ones, and their neighbours as support.
  /// None if there is no next level. [F]
  [[nodiscard]] Buffer<uint8_t> with_children() const;
};

/// Returns the choice of all of level 0, or of the level below `above`: the children of the faces that `above` has
/// marked red. Only the region's entries are filled in, and no edge is split.
[[nodiscard]] LevelChoice choose_coarsest(std::shared_ptr<const HierarchyLevel> level);
[[nodiscard]] LevelChoice choose_below(const LevelChoice& above, std::shared_ptr<const HierarchyLevel> level);

/// Marks faces of the choice's region whose children are the region of the next choice.
void mark_red(LevelChoice& choice, const Buffer<uint32_t>& faces);

}  // namespace papilio
