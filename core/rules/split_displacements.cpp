#include "rules/split_displacements.h"

#include <optional>

#include "mesh/normals.h"
#include "rules/butterfly.h"
#include "rules/tension.h"

namespace papilio {

Displacements split_displacements(const Displacements& at_vertices, const Mesh& mesh, const Options& options,
                                  const SplitPlan& plan) {
  if (at_vertices.empty()) return {};
  std::optional<TensionField> field;
  if (options.tension != Tension::off) field = tension_field(mesh, face_normals(mesh), options.tension);
  const ButterflyOfVectors rules(mesh.topology, mesh.positions.data(), plan, options.w, field ? &*field : nullptr);
  Displacements at_edges;
  for (const Displacement& displacement : at_vertices) {
    const Buffer<Vec3d> made = rules.split(displacement.at);
    at_edges.push_back({displacement.attribute, Buffer<Vec3d>(mesh.topology.edge_count(), unknown_displacement())});
    Buffer<Vec3d>& at = at_edges.back().at;
    for (uint32_t e = 0; e < at.size(); ++e)
      if (plan.is_split(e)) at[e] = made[plan.before[e]];
  }
  return at_edges;
}

}  // namespace papilio
