#include "rules/tension.h"

#include <algorithm>

#include "mesh/normals.h"

namespace papilio {
namespace {

void find_features(const Topology& mesh, TensionField& field) {
  field.feature_degree.assign(mesh.vertex_count, 0);
  field.feature_neighbours.assign(mesh.vertex_count, 0);
  const auto join = [&](uint32_t v, uint32_t other) {
    if (field.feature_degree[v] < 3) ++field.feature_degree[v];
    field.feature_neighbours[v] ^= other;
  };
  for (uint32_t e = 0; e < mesh.edge_count(); ++e) {
    if (!field.is_sharp(e)) continue;
    const uint32_t h = mesh.half_edge[e];
    join(mesh.origin[h], mesh.tip(h));
    join(mesh.tip(h), mesh.origin[h]);
  }
}

}  // namespace

double hinge_factor(double normal_product) {
  constexpr double nothing_at = 0;  // 90 degrees
  constexpr double whole_at = 0.5;  // 60 degrees
  const double s = std::clamp((normal_product - nothing_at) / (whole_at - nothing_at), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

TensionField tension_field(const Mesh& mesh, const Buffer<Vec3f>& normals, Tension tension) {
  const Topology& topology = mesh.topology;
  TensionField field{.factor = Buffer<float>(topology.edge_count(), 1), .follow_features = tension == Tension::sharp};
  for (uint32_t e = 0; e < topology.edge_count(); ++e) {
    if (topology.kind[e] != EdgeKind::smooth) continue;
    const uint32_t h = topology.half_edge[e];
    const Vec3f n1 = normals[Topology::face(h)];
    const Vec3f n2 = normals[Topology::face(topology.twin[h])];
    if (has_normal(n1) && has_normal(n2)) field.factor[e] = static_cast<float>(hinge_factor(dot(n1, n2)));
  }
  if (field.follow_features) find_features(topology, field);
  if (topology.shape.has_rules) field.shape = shape_field(mesh, normals);
  return field;
}

}  // namespace papilio
