#include "mesh/smoothing_groups.h"

#include <algorithm>
#include <vector>

#include "base/ids.h"

namespace papilio {
namespace {

/// Returns [F] the group of each face; empty without an attribute of smoothing groups.
std::vector<double> groups_of_faces(const Mesh& mesh) {
  const PointAttributes& attributes = mesh.attributes;
  const auto groups = std::ranges::find_if(
      attributes.attributes, [](const Attribute& a) { return a.is_smoothing_group && a.components == 1; });
  std::vector<double> of_faces;
  if (groups == attributes.attributes.end()) return of_faces;
  for (FaceId f = 0; f < mesh.topology.face_count(); ++f) of_faces.push_back(groups->values[attributes.point[3 * f]]);
  return of_faces;
}

}  // namespace

uint32_t mark_group_creases(Mesh& mesh) {
  const std::vector<double> groups = groups_of_faces(mesh);
  if (groups.empty()) return 0;
  Topology& topology = mesh.topology;
  uint32_t marked = 0;
  for (EdgeId e = 0; e < topology.edge_count(); ++e) {
    const HalfEdgeId h = topology.half_edge[e];
    if (topology.twin[h] == none || groups[h.face()] == groups[Topology::face(topology.twin[h])]) continue;
    topology.kind[e] = EdgeKind::crease;
    ++marked;
  }
  return marked;
}

}  // namespace papilio
