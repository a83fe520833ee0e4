#include "proto/gltf/morph_targets.h"

#include <algorithm>

namespace papilio::proto::gltf {
namespace {

std::vector<Vec3d> vectors_of(const Attribute& attribute) {
  std::vector<Vec3d> vectors(attribute.values.size() / 3);
  for (size_t i = 0; i < vectors.size(); ++i)
    vectors[i] = {attribute.values[3 * i], attribute.values[3 * i + 1], attribute.values[3 * i + 2]};
  return vectors;
}

/// Returns the differences between the normals of the moved mesh and those of the mesh.
std::vector<Vec3d> turn_of(const Mesh& mesh, const std::vector<Vec3d>& displacement, size_t normals) {
  Mesh moved{mesh.topology, mesh.positions, {}};
  moved.attributes.point = mesh.attributes.point;
  moved.attributes.point_count = mesh.attributes.point_count;
  moved.attributes.attributes = {mesh.attributes.attributes[normals]};
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
    const uint32_t v = mesh.topology.origin[h];
    moved.positions[v] = to_float(to_double(mesh.positions[v]) + displacement[mesh.attributes.point[h]]);
  }
  renew_normals(moved, 0);
  std::vector<Vec3d> turn = vectors_of(moved.attributes.attributes[0]);
  const std::vector<Vec3d> own = vectors_of(mesh.attributes.attributes[normals]);
  for (size_t p = 0; p < turn.size(); ++p) turn[p] -= own[p];
  return turn;
}

bool has_normals(const MeshGeometry& geometry, size_t target) {
  return std::ranges::any_of(geometry.sets, [&](const VertexSet& set) {
    return target < set.targets.size() &&
           std::ranges::any_of(set.targets[target], [](const VertexStream& s) { return s.semantic == "NORMAL"; });
  });
}

}  // namespace

std::vector<RefinedTarget> refine_targets(const MeshGeometry& geometry, const Surface& surface, const Mesh& refined,
                                          std::optional<size_t> normals) {
  std::vector<RefinedTarget> targets(surface.target_count);
  for (size_t t = 0; t < targets.size(); ++t) {
    targets[t].displacement = vectors_of(refined.attributes.attributes[surface.first_displacement() + t]);
    if (normals && has_normals(geometry, t)) targets[t].turn = turn_of(refined, targets[t].displacement, *normals);
  }
  return targets;
}

}  // namespace papilio::proto::gltf
