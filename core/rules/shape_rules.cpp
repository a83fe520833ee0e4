#include "rules/shape_rules.h"

#include <algorithm>
#include <array>

#include "mesh/hinge.h"

namespace papilio {
namespace {

double squared_height(const Mesh& mesh, uint32_t f) {
  const auto at = [&](uint32_t i) { return to_double(mesh.positions[mesh.topology.origin[3 * f + i]]); };
  const std::array<Vec3d, 3> side{at(1) - at(0), at(2) - at(1), at(0) - at(2)};
  const double longest = std::max({dot(side[0], side[0]), dot(side[1], side[1]), dot(side[2], side[2])});
  const Vec3d normal = cross(side[0], side[1]);
  return longest > 0 ? dot(normal, normal) / longest : 0;
}

/// Whether the faces at h are surely not in one plane: most are spared the exact answer.
bool is_surely_bent(const Mesh& mesh, const Buffer<Vec3f>& normals, uint32_t h) {
  const Topology& topology = mesh.topology;
  const uint32_t t = topology.twin[h];
  const Vec3f a = mesh.positions[topology.origin[h]];
  const auto is_beside = [&](uint32_t side, uint32_t apex) {
    const Vec3f off = mesh.positions[topology.apex(apex)] - a;
    return static_cast<double>(std::abs(dot(normals[Topology::face(side)], off))) > 2 * topology.shape.flat_distance;
  };
  return is_beside(h, t) && is_beside(t, h);
}

/// Along u without what it has along `unit`, of length one.
Vec3d without(Vec3d u, Vec3d unit) { return u - dot(u, unit) * unit; }

}  // namespace

ShapeField shape_field(const Mesh& mesh, const Buffer<Vec3f>& normals) {
  const Topology& topology = mesh.topology;
  ShapeField field{.is_flat = Buffer<uint8_t>(topology.edge_count(), 0),
                   .squared_height = Buffer<double>::for_overwrite(topology.face_count())};
  for (uint32_t f = 0; f < topology.face_count(); ++f) field.squared_height[f] = squared_height(mesh, f);
  for (uint32_t e = 0; e < topology.edge_count(); ++e) {
    const uint32_t h = topology.half_edge[e];
    if (topology.kind[e] != EdgeKind::smooth || is_surely_bent(mesh, normals, h)) continue;
    field.is_flat[e] = Hinge(topology, mesh.positions, h).is_flat(topology.shape.flat_distance) ? 1 : 0;
  }
  return field;
}

Vec3d keep_unfolded(Vec3d off, Vec3d a, Vec3d b, std::span<const FaceAtEdge> faces, double across_bound) {
  double least = faces[0].height;
  for (const FaceAtEdge& face : faces) least = std::min(least, face.height);
  const Vec3d edge = b - a;
  const double size = length(edge);
  if (!(size > 0)) return off;

  const Vec3d along = 1 / size * edge;
  const Vec3d middle = 0.5 * (a + b);
  std::array<Vec3d, 2> inward;
  std::array<double, 2> excess{};
  for (size_t i = 0; i < faces.size(); ++i) {
    const Vec3d across = without(faces[i].apex - middle, along);
    const double distance = length(across);
    if (!(distance > 0)) continue;
    inward[i] = 1 / distance * across;
    excess[i] = std::max(0.0, dot(off, inward[i]) - inward_bound * faces[i].height);
  }
  if (excess[0] > 0 && excess[1] > 0) {
    const double together = 1 + std::max(0.0, dot(inward[0], inward[1]));
    for (double& each : excess) each /= together;
  }
  off -= excess[0] * inward[0] + excess[1] * inward[1];
  const Vec3d across = without(off, along);
  const double distance = length(across);
  const double most = across_bound * least;
  return distance > most ? off - (1 - most / distance) * across : off;
}

}  // namespace papilio
