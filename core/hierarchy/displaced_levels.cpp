#include "hierarchy/displaced_levels.h"

#include "hierarchy/detail_levels.h"
#include "rules/split_displacements.h"

namespace papilio {
namespace {

/// Returns the displacements at the vertices of the level below, given those at vertices and edges of the level above.
Displacements at_vertices_below(const HierarchyLevel& above, const HierarchyLevel& below,
                                const Displacements& at_vertices, const Displacements& at_edges) {
  const Topology& parents = above.mesh.topology;
  const Topology& mesh = below.mesh.topology;
  Displacements out;
  for (size_t i = 0; i < at_vertices.size(); ++i) {
    out.push_back({at_vertices[i].attribute, Buffer<Vec3d>(mesh.vertex_count, unknown_displacement())});
    Buffer<Vec3d>& at = out.back().at;
    for (uint32_t child = 0; child < mesh.face_count(); child += 4) {
      const uint32_t parent = below.parent_of(child);
      const uint32_t* corner = &parents.origin[size_t{3} * parent];
      const uint32_t* edge = &parents.edge[size_t{3} * parent];
      const uint32_t* of_children = &mesh.origin[size_t{3} * child];
      for (uint32_t c = 0; c < 3; ++c) {
        // Corner c of child c is the parent's corner c; the next is the middle of the parent's side c.
        at[of_children[3 * c + c]] = at_vertices[i].at[corner[c]];
        at[of_children[3 * c + (c + 1) % 3]] = at_edges[i].at[edge[c]];
      }
    }
  }
  return out;
}

std::vector<Displacements> rule_displacements_of(std::span<const LevelChoice> levels, const Options& options) {
  const Mesh& coarse = levels[0].level->mesh;
  std::vector<Displacements> of_levels;
  if (!has_displacements(coarse.attributes)) return of_levels;
  Displacements at_vertices = displacements_at_vertices(coarse);
  for (size_t k = 0; k < levels.size(); ++k) {
    const HierarchyLevel& level = *levels[k].level;
    of_levels.push_back(split_displacements(at_vertices, level.mesh, options, complete_edges(level)));
    if (k + 1 < levels.size())
      at_vertices = at_vertices_below(level, *levels[k + 1].level, at_vertices, of_levels.back());
  }
  return of_levels;
}

}  // namespace

std::vector<Displacements> displacements_of(std::span<const LevelChoice> levels, const Options& options) {
  const Mesh& coarse = levels[0].level->mesh;
  std::vector<Displacements> of_levels = rule_displacements_of(levels, options);
  if (!coarse.detail) return of_levels;
  of_levels.resize(levels.size());
  for (size_t k = 0; k < levels.size(); ++k) {
    const HierarchyLevel& level = *levels[k].level;
    if (level.detail_levels > 0)
      add_values_of_detail(coarse, *coarse.detail, coarse.detail->level_count() - level.detail_levels,
                           level.in_whole.parent, of_levels[k]);
  }
  return of_levels;
}

}  // namespace papilio
