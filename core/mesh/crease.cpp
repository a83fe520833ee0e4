#include "mesh/crease.h"

#include <algorithm>

#include "base/trigonometry.h"
#include "mesh/curve.h"
#include "mesh/normals.h"

namespace papilio {

std::vector<uint32_t> find_darts(const Topology& mesh) {
  const VertexDegrees curves(mesh, [&](EdgeId e) { return mesh.kind[e] != EdgeKind::smooth; });
  // A single curve edge is a crease: a vertex has boundaries and shared edges in pairs.
  std::vector<uint32_t> darts;
  for (VertexId v = 0; v < mesh.vertex_count; ++v)
    if (curves.degree[v] == 1 && !std::ranges::binary_search(mesh.pinched, uint32_t{v})) darts.push_back(v);
  return darts;
}

void mark_creases(Mesh& mesh, double degrees) {
  if (degrees >= 180) return;
  Topology& topology = mesh.topology;
  const double least_product = cosine_of_degrees(degrees) - product_rounding;
  const Buffer<Vec3f> normals = face_normals(mesh);
  for (EdgeId e = 0; e < topology.edge_count(); ++e) {
    if (topology.kind[e] != EdgeKind::smooth) continue;
    const HalfEdgeId h = topology.half_edge[e];
    const Vec3f n1 = normals[h.face()];
    const Vec3f n2 = normals[Topology::face(topology.twin[h])];
    if (has_normal(n1) && has_normal(n2) && dot(n1, n2) < least_product) topology.kind[e] = EdgeKind::crease;
  }
  topology.darts = find_darts(topology);
}

}  // namespace papilio
