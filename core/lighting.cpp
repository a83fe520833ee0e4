#include "lighting.h"

#include <algorithm>
#include <cmath>

#include "normals.h"

namespace papilio {
namespace {

/// Lambert's law over all lights; 0..1.
double brightness(const View& view, Vec3d normal) {
  double sum = 0;
  for (const Vec3d& light : view.lights) sum += std::max(0.0, dot(normal, light) / length(light));
  return std::min(1.0, sum);
}

constexpr double least = 0.1;       // what is left where the shading does not change at all
constexpr double silhouette = 1.0;  // contrast against whatever is behind

}  // namespace

double light_weight(const Mesh& mesh, const std::vector<Vec3f>& normals, uint32_t edge, const View& view,
                    const Camera& camera) {
  const Topology& topology = mesh.topology;
  const uint32_t h = topology.half_edge[edge];
  if (topology.kind[edge] == EdgeKind::boundary || topology.kind[edge] == EdgeKind::shared) return least + silhouette;
  const Vec3d n1 = to_double(normals[Topology::face(h)]);
  const Vec3d n2 = to_double(normals[Topology::face(topology.twin[h])]);
  const Vec3d on_both = to_double(mesh.positions[topology.origin[h]]);
  if (camera.is_away(on_both, n1) != camera.is_away(on_both, n2)) return least + silhouette;
  return least + std::abs(brightness(view, n1) - brightness(view, n2));
}

}  // namespace papilio
