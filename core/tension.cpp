#include "tension.h"

#include <algorithm>

#include "normals.h"

namespace papilio {

double hinge_factor(double normal_product) {
  constexpr double none_at = 0;     // 90 degrees
  constexpr double whole_at = 0.5;  // 60 degrees
  const double s = std::clamp((normal_product - none_at) / (whole_at - none_at), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

std::vector<float> hinge_factors(const Topology& mesh, const std::vector<Vec3f>& normals) {
  std::vector<float> factors(mesh.edge_count(), 1);
  for (uint32_t e = 0; e < mesh.edge_count(); ++e) {
    const uint32_t h = mesh.half_edge[e];
    const uint32_t t = mesh.twin[h];
    if (t == none) continue;
    const Vec3f n1 = normals[Topology::face(h)];
    const Vec3f n2 = normals[Topology::face(t)];
    if (has_normal(n1) && has_normal(n2)) factors[e] = static_cast<float>(hinge_factor(dot(n1, n2)));
  }
  return factors;
}

}  // namespace papilio
