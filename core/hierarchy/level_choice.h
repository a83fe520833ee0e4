#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "criteria/view_culling.h"
#include "hierarchy/hierarchy.h"
#include "mesh/region.h"

namespace papilio {

/// What one request makes of a level. Its region are the faces that it may show: all at level 0, below the children of
/// the faces that it looked into; it is often much less than the level holds. Where arrays are as long as the level's,
/// only what belongs to the region is looked at.
struct LevelChoice {
  std::shared_ptr<const HierarchyLevel> level;
  Region region;     ///< its edges are the only ones that may be split
  EdgesShown shown;  ///< those of them that the view shows
  /// [E] how much the edge wants to be split: its own error, or the error of what lies below and needs it split; minus
  /// infinity where nothing wants it. Empty where errors do not decide.
  Buffer<float> error;
  Buffer<uint32_t> candidates;   ///< the edges whose error reaches the least threshold; else all that are wanted
  EdgeMarks split;               ///< [E] what is split for the result
  Buffer<uint32_t> split_edges;  ///< the same as a list
  Buffer<uint8_t> transitions;   ///< [F] what is known of faces split in part (transition.h); may be empty
  Buffer<uint8_t> red;           ///< [F] whose children are the region of the next choice; empty while there is none
  Buffer<uint32_t> at_outline;   ///< those of the red faces that were not divided when they were marked (outline.h)

  /// Bit i is set where edge i of the face is split.
  [[nodiscard]] unsigned split_mask(uint32_t face) const {
    const uint32_t* edge = &level->mesh.topology.edge[size_t{3} * face];
    return split[edge[0]] | split[edge[1]] << 1U | split[edge[2]] << 2U;
  }
  void split_edge(uint32_t edge) {
    if (split[edge] != 0) return;
    split[edge] = 1;
    split_edges.push_back(edge);
  }
  /// Where nothing is split yet: these, no edge twice.
  void split_first(Buffer<uint32_t> edges) {
    for (uint32_t e : edges) split[e] = 1;
    split_edges = std::move(edges);
  }
  void split_nothing() {
    for (uint32_t e : split_edges) split[e] = 0;
    split_edges.clear();
  }
  /// How many faces there are at all edges that are split together. Edges of the region have all their faces there.
  [[nodiscard]] uint64_t count_faces_of_split() const;
  /// The faces at edges that are split, in ascending order.
  [[nodiscard]] Buffer<uint32_t> faces_at_split() const;
  struct PartlySplit {
    uint32_t face;
    unsigned mask;  ///< of its edges, as above
  };
  /// Those of them of which not all edges are.
  [[nodiscard]] Buffer<PartlySplit> faces_split_in_part() const;
  /// Calls `visit(parent, edges)` for each face of the level above whose children are in the region, which lies below
  /// level 0, with the 12 edges of its children's half-edges.
  template <class Visit>
  void visit_parents(const Visit& visit) const {
    for (size_t i = 0; i < region.faces.size(); i += 4) {
      const uint32_t f = region.faces[i];
      visit(level->parent_of(f), &level->mesh.topology.edge[size_t{3} * f]);
    }
  }
  /// Whether an edge is split of the children of a face of the level above, whose children are in the region.
  [[nodiscard]] bool splits_below(uint32_t parent) const {
    const uint32_t* edge = &level->mesh.topology.edge[size_t{3} * level->first_child_of(parent)];
    return std::any_of(edge, edge + 12, [&](uint32_t e) { return split[e] != 0; });
  }
  /// Whether all the face's edges may be split.
  [[nodiscard]] bool may_divide(uint32_t face) const {
    const uint32_t* edge = &level->mesh.topology.edge[size_t{3} * face];
    return (region.has_edge[edge[0]] & region.has_edge[edge[1]] & region.has_edge[edge[2]]) != 0;
  }
  /// The faces whose children the next level holds for this request: red ones, and their neighbours as support. None
  /// where there is no next level. [F]
  [[nodiscard]] Buffer<uint8_t> with_children() const;

 private:
  [[nodiscard]] bool has_many_split() const;
};

/// Choice of all of level 0; of the level below `above`, of the children of the faces that `above` has marked red. Only
/// what belongs to the region is filled in, and nothing is split.
[[nodiscard]] LevelChoice choose_coarsest(std::shared_ptr<const HierarchyLevel> level);
[[nodiscard]] LevelChoice choose_below(const LevelChoice& above, std::shared_ptr<const HierarchyLevel> level);

/// Marks faces of the choice's region as those whose children the next choice is made of.
void mark_red(LevelChoice& choice, const Buffer<uint32_t>& faces);

}  // namespace papilio
