#include "rules/shape_rules.h"

#include <algorithm>
#include <array>
#include <limits>

#include "mesh/hinge.h"
#include "mesh/normals.h"
#include "simd/extremes.h"

namespace papilio {
namespace {

double squared_height(const Mesh& mesh, FaceId f) {
  const auto at = [&](uint32_t i) { return to_double(mesh.positions[mesh.topology.origin[3 * f + i]]); };
  const std::array<Vec3d, 3> side{at(1) - at(0), at(2) - at(1), at(0) - at(2)};
  const double longest = larger(dot(side[0], side[0]), dot(side[1], side[1]), dot(side[2], side[2]));
  const Vec3d normal = cross(side[0], side[1]);
  return longest > 0 ? dot(normal, normal) / longest : 0;
}

/// Returns whether the faces at h are surely not in one plane: a cheap test before the exact one.
bool is_surely_bent(const Mesh& mesh, const Buffer<Vec3f>& normals, HalfEdgeId h) {
  const Topology& topology = mesh.topology;
  const HalfEdgeId t = topology.twin[h];
  const Vec3f a = mesh.positions[topology.origin[h]];
  const auto is_beside = [&](uint32_t side, uint32_t apex) {
    const Vec3f off = mesh.positions[topology.apex(apex)] - a;
    return static_cast<double>(std::abs(dot(normals[Topology::face(side)], off))) > 2 * topology.shape.flat_distance;
  };
  return is_beside(h, t) && is_beside(t, h);
}

/// Returns the least cosine of the face's hinges. Faces without a normal, and sides without a twin, have none.
float sharpest_hinge(const Topology& mesh, const Buffer<Vec3f>& normals, FaceId f) {
  float least = 1;
  for (HalfEdgeId h = 3 * f; h < 3 * f + 3; ++h) {
    const HalfEdgeId t = mesh.twin[h];
    if (t != none && has_normal(normals[t.face()])) least = lesser(least, dot(normals[f], normals[t.face()]));
  }
  return has_normal(normals[f]) ? least : 1;
}

/// Computes `ShapeField::squared_height_at_shared`.
Buffer<double> squared_heights_at_shared(const Topology& mesh, const Buffer<double>& squared_height) {
  Buffer<double> least;
  if (std::ranges::find(mesh.kind, EdgeKind::shared) == mesh.kind.end()) return least;
  least.assign(mesh.edge_count(), std::numeric_limits<double>::infinity());
  const double flat = mesh.shape.flat_distance * mesh.shape.flat_distance;
  for (HalfEdgeId h = 0; h < mesh.half_edge_count(); ++h)
    if (squared_height[h.face()] > flat) least[mesh.edge[h]] = std::min(least[mesh.edge[h]], squared_height[h.face()]);
  return least;
}

/// Returns u without its component along `unit`, a unit vector.
Vec3d without(Vec3d u, Vec3d unit) { return u - dot(u, unit) * unit; }

}  // namespace

ShapeField shape_field(const Mesh& mesh, const Buffer<Vec3f>& normals) {
  const Topology& topology = mesh.topology;
  const uint32_t faces = topology.face_count();
  ShapeField field{.is_flat = Buffer<uint8_t>(topology.edge_count(), 0),
                   .squared_height = Buffer<double>::for_overwrite(faces),
                   .sharpest = Buffer<float>::for_overwrite(topology.shape.is_mechanical ? faces : 0)};
  for (FaceId f = 0; f < faces; ++f) {
    field.squared_height[f] = squared_height(mesh, f);
    if (topology.shape.is_mechanical) field.sharpest[f] = sharpest_hinge(topology, normals, f);
  }
  field.squared_height_at_shared = squared_heights_at_shared(topology, field.squared_height);
  for (EdgeId e = 0; e < topology.edge_count(); ++e) {
    const HalfEdgeId h = topology.half_edge[e];
    if (topology.kind[e] != EdgeKind::smooth || is_surely_bent(mesh, normals, h)) continue;
    field.is_flat[e] = Hinge(topology, mesh.positions, h).is_flat(topology.shape.flat_distance) ? 1 : 0;
  }
  return field;
}

Vec3d keep_unfolded(Vec3d off, Vec3d a, Vec3d b, std::span<const FaceAtEdge> faces, double across_bound) {
  double least = faces[0].height;
  for (const FaceAtEdge& face : faces) least = lesser(least, face.height);
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
    excess[i] = larger(0.0, dot(off, inward[i]) - inward_bound * faces[i].height);
  }
  if (excess[0] > 0 && excess[1] > 0) {
    const double together = 1 + larger(0.0, dot(inward[0], inward[1]));
    for (double& each : excess) each /= together;
  }
  off -= excess[0] * inward[0] + excess[1] * inward[1];
  const Vec3d across = without(off, along);
  double share = 1;
  const auto limit = [&](double moved, double most) {
    if (moved > most) share = lesser(share, most / moved);
  };
  limit(length(across), across_bound * least);
  for (size_t i = 0; i < faces.size(); ++i)
    limit(std::abs(dot(across, cross(along, inward[i]))), faces[i].room * across_bound * faces[i].height);
  return share < 1 ? off - (1 - share) * across : off;
}

Vec3d shorten_across(Vec3d off, Vec3d a, Vec3d b, double most) {
  const Vec3d edge = b - a;
  const double size = length(edge);
  if (!(size > 0)) return off;
  const Vec3d across = without(off, 1 / size * edge);
  const double distance = length(across);
  return distance > most ? off - (1 - most / distance) * across : off;
}

}  // namespace papilio
