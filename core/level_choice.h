#pragma once

#include <memory>
#include <vector>

#include "hierarchy.h"
#include "region.h"

namespace papilio {

/// What one request makes of a level. Its region are the faces that it may show: all at level 0, below the children of
/// the faces that it looked into; it is often much less than the level holds. Where arrays are as long as the level's,
/// only what belongs to the region is looked at.
struct LevelChoice {
  std::shared_ptr<const HierarchyLevel> level;
  Region region;           ///< `edges`: the only ones that may be split
  EdgeMarks may_be_split;  ///< [E] the region's edges
  EdgesShown shown;        ///< those of them that the view shows
  /// [E] how much the edge wants to be split: its own error, or the error of what lies below and needs it split; minus
  /// infinity where nothing wants it.
  std::vector<float> error;
  std::vector<uint32_t> candidates;   ///< the edges whose error reaches the least threshold there may be
  EdgeMarks split;                    ///< [E] what is split for the result
  std::vector<uint32_t> split_edges;  ///< the same as a list
  std::vector<uint8_t> red;       ///< [F] whose children are the region of the next choice; empty while there is none
  std::vector<uint8_t> at_a_red;  ///< [V] whether a red face is there

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
  void split_nothing() {
    for (uint32_t e : split_edges) split[e] = 0;
    split_edges.clear();
  }
  /// Calls `visit(face, edge)` for each face at each edge of a list, which are those that `is_listed`. Edges of the
  /// region have all their faces there.
  template <class IsListed, class Visit>
  void visit_faces(const std::vector<uint32_t>& edges, const IsListed& is_listed, const Visit& visit) const {
    const Topology& mesh = level->mesh.topology;
    for (uint32_t e : edges) {
      if (mesh.kind[e] == EdgeKind::shared) continue;
      const uint32_t h = mesh.half_edge[e];
      visit(Topology::face(h), e);
      if (mesh.twin[h] != none) visit(Topology::face(mesh.twin[h]), e);
    }
    for (uint32_t h : level->shared)
      if (is_listed(mesh.edge[h])) visit(Topology::face(h), mesh.edge[h]);
  }
  /// The same for the edges that are split.
  template <class Visit>
  void visit_faces_of_split(const Visit& visit) const {
    visit_faces(
        split_edges, [&](uint32_t e) { return split[e] != 0; }, visit);
  }
  /// Whether all the face's edges may be split.
  [[nodiscard]] bool may_divide(uint32_t face) const {
    const uint32_t* edge = &level->mesh.topology.edge[size_t{3} * face];
    return (may_be_split[edge[0]] & may_be_split[edge[1]] & may_be_split[edge[2]]) != 0;
  }
  /// Whether the next level holds the face's children for this request: a red face's, or as support.
  [[nodiscard]] bool has_children(uint32_t face) const {
    if (at_a_red.empty()) return false;
    const uint32_t* corner = &level->mesh.topology.origin[size_t{3} * face];
    return (at_a_red[corner[0]] | at_a_red[corner[1]] | at_a_red[corner[2]]) != 0;
  }
};

/// Choice of all of level 0; of the level below `above`, of the children of the faces that `above` has marked red. Only
/// what belongs to the region is filled in, and nothing is split.
[[nodiscard]] LevelChoice choose_coarsest(std::shared_ptr<const HierarchyLevel> level);
[[nodiscard]] LevelChoice choose_below(const LevelChoice& above, std::shared_ptr<const HierarchyLevel> level);

/// Marks faces of the choice's region as those whose children the next choice is made of.
void mark_red(LevelChoice& choice, const std::vector<uint32_t>& faces);

}  // namespace papilio
