#include "detail/own_normals.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "detail/sharp_curves.h"
#include "mesh/attributes.h"
#include "mesh/hinge.h"
#include "mesh/surface_normals.h"

namespace papilio {
namespace {

constexpr double to_radians = std::numbers::pi / 180;
/// Lower bound of the angle between split normals of a vertex.
constexpr double hard_angle = 5 * to_radians;
/// Lower bound of the angle between the faces of a bent edge.
constexpr double bent_angle = 1 * to_radians;
/// Lower bound of the angle between normals at a faceted edge, a share of the angle between its faces.
constexpr double faceted_share_of_angle = 0.5;
/// Lower bounds of the faceted edges of a faceted original, as shares of the bent edges and of all edges.
constexpr double faceted_share_of_bent = 0.95, faceted_share_of_all = 0.3;

double angle_between(Vec3d a, Vec3d b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

bool are_normals(const Attribute& attribute) { return attribute.components == 3 && attribute.unit_length; }

}  // namespace

OwnNormals find_own_normals(const Mesh& mesh) {
  const Topology& t = mesh.topology;
  const auto normals = std::ranges::find_if(mesh.attributes.attributes, are_normals);
  if (normals == mesh.attributes.attributes.end()) return {};
  const auto angle = [&](uint32_t h, uint32_t other) {
    const Buffer<uint32_t>& point = mesh.attributes.point;
    return angle_between(vector_at(*normals, point[h]), vector_at(*normals, point[other]));
  };
  OwnNormals found{.style = NormalStyle::smooth, .is_hard = std::vector<bool>(t.edge_count())};
  uint32_t inner = 0, bent = 0, faceted = 0, hard = 0;
  for (uint32_t e = 0; e < t.edge_count(); ++e) {
    const uint32_t h = t.half_edge[e];
    const uint32_t twin = t.twin[h];
    if (twin == none) continue;
    ++inner;
    const auto [least, most] = std::minmax({angle(h, Topology::next(twin)), angle(Topology::next(h), twin)});
    found.is_hard[e] = most > hard_angle;
    hard += found.is_hard[e] ? 1 : 0;
    const double turn = std::acos(std::clamp(Hinge(t, mesh.positions, h).cosine(), -1.0, 1.0));
    if (turn <= bent_angle) continue;
    ++bent;
    faceted += least >= faceted_share_of_angle * turn ? 1 : 0;
  }
  if (faceted > 0 && faceted >= faceted_share_of_bent * bent && faceted >= faceted_share_of_all * inner)
    found.style = NormalStyle::faceted;
  else if (hard > 0)
    found.style = NormalStyle::creased;
  if (found.style != NormalStyle::creased) found.is_hard.clear();
  return found;
}

std::vector<Attribute> without_normals(const std::vector<Attribute>& attributes) {
  std::vector<Attribute> others = attributes;
  std::erase_if(others, are_normals);
  return others;
}

bool add_detail_normals(Mesh& mesh, NormalStyle style) {
  if (!has_detail_normals(style)) return false;
  if (style == NormalStyle::smooth) std::ranges::replace(mesh.topology.kind, EdgeKind::crease, EdgeKind::smooth);
  add_weighted_normals(mesh, FaceWeight::angle);
  return true;
}

NormalStyle mark_detail_curves(Mesh& mesh) {
  const OwnNormals normals = find_own_normals(mesh);
  if (normals.style != NormalStyle::absent) {
    TriangleMesh triangles = std::move(mesh).triangles();
    std::erase_if(triangles.attributes, are_normals);
    mesh = build_mesh(triangles);
  }
  mark_sharp_curves(mesh, normals.is_hard);
  if (normals.style != NormalStyle::creased) return normals.style;
  const bool has_creases = std::ranges::count(mesh.topology.kind, EdgeKind::crease) > 0;
  return has_creases ? NormalStyle::creased : NormalStyle::smooth;  // noisy hard edges are smooth
}

}  // namespace papilio
