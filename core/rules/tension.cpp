#include "rules/tension.h"

#include "mesh/normals.h"
#include "simd/extremes.h"

namespace papilio {

double hinge_factor(double normal_product) {
  constexpr double nothing_at = 0;  // 90 degrees
  constexpr double whole_at = 0.5;  // 60 degrees
  const double s = lesser(larger((normal_product - nothing_at) / (whole_at - nothing_at), 0.0), 1.0);
  return s * s * (3 - 2 * s);
}

TensionField tension_field(const Mesh& mesh, const Buffer<Vec3f>& normals, Tension tension) {
  const Topology& topology = mesh.topology;
  TensionField field{.factor = Buffer<float>(topology.edge_count(), 1), .follow_features = tension == Tension::sharp};
  for (EdgeId e = 0; e < topology.edge_count(); ++e) {
    if (topology.kind[e] != EdgeKind::smooth) continue;
    const HalfEdgeId h = topology.half_edge[e];
    const Vec3f n1 = normals[h.face()];
    const Vec3f n2 = normals[Topology::face(topology.twin[h])];
    if (has_normal(n1) && has_normal(n2)) field.factor[e] = static_cast<float>(hinge_factor(dot(n1, n2)));
  }
  if (field.follow_features) field.features = {topology, [&](EdgeId e) { return field.is_sharp(e); }};
  if (topology.shape.has_rules) field.shape = shape_field(mesh, normals);
  return field;
}

}  // namespace papilio
