#include "rules/split_displacements.h"

#include <optional>

#include "mesh/normals.h"
#include "rules/butterfly.h"
#include "rules/tension.h"

namespace papilio {

Displacements split_displacements(const Displacements& at_vertices, const Mesh& mesh, const Options& options,
                                  const Marks& complete) {
  if (at_vertices.empty()) return {};
  std::optional<TensionField> field;
  if (options.tension != Tension::off) field = tension_field(mesh, face_normals(mesh), options.tension);
  const ButterflyOfVectors rules(mesh.topology, mesh.positions.data(),
                                 {.w = options.w, .tension = field ? &*field : nullptr, .complete = &complete});
  Displacements at_edges;
  for (const Displacement& displacement : at_vertices) {
    at_edges.push_back({displacement.attribute, rules.split(displacement.at)});
    for (EdgeId e = 0; e < complete.size(); ++e)
      if (complete[e] == 0) at_edges.back().at[e] = unknown_displacement();
  }
  return at_edges;
}

}  // namespace papilio
