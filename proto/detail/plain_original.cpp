#include "proto/detail/plain_original.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace papilio::proto::detail {
namespace {

/// Upper bound of the mean error of derived normals, in degrees.
constexpr double most_degrees = 20;
/// Upper bound of the missing and surplus creases of derived normals, a share of the length of all creases.
constexpr double most_wrong_creases = 0.02;

double degrees_between(Vec3d a, Vec3d b) { return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi; }

/// Returns the mean angle between the last attributes of two meshes with equal faces.
double mean_angle(const Mesh& a, const Mesh& b) {
  const auto normal_of = [](const Mesh& mesh, uint32_t h) {
    const double* value = &mesh.attributes.attributes.back().values[size_t{3} * mesh.attributes.point[h]];
    return Vec3d{value[0], value[1], value[2]};
  };
  double sum = 0;
  for (uint32_t h = 0; h < a.topology.half_edge_count(); ++h) sum += degrees_between(normal_of(a, h), normal_of(b, h));
  return sum / a.topology.half_edge_count();
}

/// Returns the length of the creases that only one of two meshes has, a share of the length of all.
double difference_of_creases(const Mesh& a, const Mesh& b) {
  const Topology& t = a.topology;
  double all = 0, different = 0;
  for (uint32_t e = 0; e < t.edge_count(); ++e) {
    const int creases = int{t.kind[e] == EdgeKind::crease} + int{b.topology.kind[e] == EdgeKind::crease};
    const uint32_t h = t.half_edge[e];
    const double size = length(to_double(a.positions[t.tip(h)]) - to_double(a.positions[t.origin[h]]));
    all += creases > 0 ? size : 0;
    different += creases == 1 ? size : 0;
  }
  return all > 0 ? different / all : 0;
}

void unmark_curves(Topology& topology) {
  std::ranges::replace(topology.kind, EdgeKind::crease, EdgeKind::smooth);
  topology.shape.corners.clear();
  topology.darts.clear();
}

}  // namespace

PlainOriginal plain_original(Mesh original) {
  const auto& attributes = original.attributes.attributes;
  if (attributes.empty() || !attributes.back().unit_length) return {.mesh = std::move(original)};
  Mesh packed = original;  // gets the creases of a packed model
  const NormalStyle style = mark_detail_curves(packed);
  PlainOriginal made{.mesh = packed, .normals = style};
  unmark_curves(made.mesh.topology);
  if (style == NormalStyle::absent || style == NormalStyle::faceted) return made;
  Mesh plain = made.mesh;  // gets the creases that readers derive
  (void)mark_detail_curves(plain);
  const bool has_same_creases =
      style == NormalStyle::smooth || difference_of_creases(packed, plain) <= most_wrong_creases;
  add_detail_normals(packed, style);
  add_detail_normals(plain, style);
  if (has_same_creases && mean_angle(original, plain) <= most_degrees) return made;
  if (mean_angle(original, packed) > most_degrees) made.compared = std::move(made.mesh);
  made.mesh = std::move(original);
  made.has_normals = true;
  return made;
}

}  // namespace papilio::proto::detail
