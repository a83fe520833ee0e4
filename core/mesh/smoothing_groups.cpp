#include "mesh/smoothing_groups.h"

#include <algorithm>
#include <vector>

#include "base/disjoint_sets.h"
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

/// Returns [F] whether all faces of a face's component, connected by edges between two faces, have one group.
std::vector<bool> find_uniform(const Topology& mesh, const std::vector<double>& groups) {
  DisjointSets components(mesh.face_count());
  for (HalfEdgeId h = 0; h < mesh.half_edge_count(); ++h)
    if (mesh.twin[h] != none) components.join(h.face(), Topology::face(mesh.twin[h]));
  std::vector<bool> is_uniform(groups.size(), true);
  for (FaceId f = 0; f < groups.size(); ++f)
    if (groups[f] != groups[components.find(f)]) is_uniform[components.find(f)] = false;
  for (FaceId f = 0; f < groups.size(); ++f) is_uniform[f] = is_uniform[components.find(f)];
  return is_uniform;
}

}  // namespace

uint32_t mark_group_creases(Mesh& mesh) {
  const std::vector<double> groups = groups_of_faces(mesh);
  if (groups.empty()) return 0;
  Topology& topology = mesh.topology;
  const std::vector<bool> is_uniform = find_uniform(topology, groups);
  uint32_t marked = 0;
  for (EdgeId e = 0; e < topology.edge_count(); ++e) {
    const HalfEdgeId h = topology.half_edge[e];
    if (topology.twin[h] == none || is_uniform[h.face()]) continue;
    const double one = groups[h.face()], other = groups[Topology::face(topology.twin[h])];
    if (one == other && one != 0) continue;
    topology.kind[e] = EdgeKind::crease;
    ++marked;
  }
  return marked;
}

}  // namespace papilio
