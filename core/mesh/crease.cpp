#include "mesh/crease.h"

#include <algorithm>

#include "base/trigonometry.h"
#include "mesh/curve.h"
#include "mesh/normals.h"

namespace papilio {

std::vector<uint32_t> find_darts(const Topology& mesh) {
  const VertexDegrees curves(mesh, [&](uint32_t e) { return mesh.kind[e] != EdgeKind::smooth; });
  // A single curve can only be a crease: boundaries and shared edges come in pairs at a vertex.
  std::vector<uint32_t> darts;
  for (uint32_t v = 0; v < mesh.vertex_count; ++v)
    if (curves.degree[v] == 1 && !std::ranges::binary_search(mesh.pinched, v)) darts.push_back(v);
  return darts;
}

void mark_creases(Mesh& mesh, double degrees) {
  if (degrees >= 180) return;
  Topology& topology = mesh.topology;
  const double least_product = cosine_of_degrees(degrees) - product_rounding;
  const Buffer<Vec3f> normals = face_normals(mesh);
  for (uint32_t e = 0; e < topology.edge_count(); ++e) {
    if (topology.kind[e] != EdgeKind::smooth) continue;
    const uint32_t h = topology.half_edge[e];
    const Vec3f n1 = normals[Topology::face(h)];
    const Vec3f n2 = normals[Topology::face(topology.twin[h])];
    if (has_normal(n1) && has_normal(n2) && dot(n1, n2) < least_product) topology.kind[e] = EdgeKind::crease;
  }
  topology.darts = find_darts(topology);
}

}  // namespace papilio
