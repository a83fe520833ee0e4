#include "hierarchy/detail_levels.h"

#include <algorithm>

#include "mesh/normals.h"
#include "papilio/detail.h"

namespace papilio {

Trial try_level(const HierarchyLevel& level, const Mesh& coarse, const Options& options, const TrialContext& context,
                const std::function<bool()>& cancelled) {
  if (level.detail_levels == 0) return try_split(level.mesh, options, context);
  const std::span<const Vec3f> vertices =
      coarse.detail->new_vertices(coarse.detail->level_count() - level.detail_levels, cancelled);
  Trial trial{.normals = face_normals(level.mesh, context.threads)};
  trial.made.resize_for_overwrite(level.mesh.topology.edge_count());
  if (level.is_whole) {
    std::ranges::copy(vertices, trial.made.begin());
  } else {
    for (uint32_t e = 0; e < trial.made.size(); ++e) trial.made[e] = vertices[level.in_whole.edge[e]];
  }
  return trial;
}

}  // namespace papilio
