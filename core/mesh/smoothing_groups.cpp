#include "mesh/smoothing_groups.h"

#include <algorithm>
#include <vector>

namespace papilio {
namespace {

/// Returns the group of each face; nothing if no attribute tells.
std::vector<double> groups_of_faces(const Mesh& mesh) {
  const PointAttributes& attributes = mesh.attributes;
  const auto groups = std::ranges::find_if(
      attributes.attributes, [](const Attribute& a) { return a.is_smoothing_group && a.components == 1; });
  std::vector<double> of_faces;
  if (groups == attributes.attributes.end()) return of_faces;
  for (uint32_t f = 0; f < mesh.topology.face_count(); ++f) of_faces.push_back(groups->values[attributes.point[3 * f]]);
  return of_faces;
}

/// Returns [F] whether all faces of a face's component, connected by edges between two faces, have one group.
std::vector<bool> find_uniform(const Topology& mesh, const std::vector<double>& groups) {
  std::vector<bool> is_uniform(groups.size()), is_seen(groups.size());
  std::vector<uint32_t> component;
  for (uint32_t first = 0; first < groups.size(); ++first) {
    if (is_seen[first]) continue;
    component.assign(1, first);
    is_seen[first] = true;
    bool has_one_group = true;
    for (size_t next = 0; next < component.size(); ++next) {
      const uint32_t f = component[next];
      has_one_group = has_one_group && groups[f] == groups[first];
      for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
        if (mesh.twin[h] == none || is_seen[Topology::face(mesh.twin[h])]) continue;
        is_seen[Topology::face(mesh.twin[h])] = true;
        component.push_back(Topology::face(mesh.twin[h]));
      }
    }
    if (has_one_group)
      for (const uint32_t f : component) is_uniform[f] = true;
  }
  return is_uniform;
}

}  // namespace

uint32_t mark_group_creases(Mesh& mesh) {
  const std::vector<double> groups = groups_of_faces(mesh);
  if (groups.empty()) return 0;
  Topology& topology = mesh.topology;
  const std::vector<bool> is_uniform = find_uniform(topology, groups);
  uint32_t marked = 0;
  for (uint32_t e = 0; e < topology.edge_count(); ++e) {
    const uint32_t h = topology.half_edge[e];
    if (topology.twin[h] == none || is_uniform[Topology::face(h)]) continue;
    const double one = groups[Topology::face(h)], other = groups[Topology::face(topology.twin[h])];
    if (one == other && one != 0) continue;
    topology.kind[e] = EdgeKind::crease;
    ++marked;
  }
  return marked;
}

}  // namespace papilio
