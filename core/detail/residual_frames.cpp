#include "detail/residual_frames.h"

namespace papilio {

namespace {

Vec3f area_normal(const Topology& mesh, const Vec3f* positions, uint32_t face) {
  const uint32_t* corner = &mesh.origin[size_t{3} * face];
  const Vec3f a = positions[corner[0]];
  return cross(positions[corner[1]] - a, positions[corner[2]] - a);
}

/// Returns [V] whether a vertex is on a boundary or a crease; empty without curves.
Buffer<uint8_t> vertices_on_curves(const DetailLevel& level) {
  Buffer<uint8_t> is_on_curve;
  if (level.curve_edges().empty()) return is_on_curve;
  const Topology& mesh = level.topology();
  is_on_curve.assign(mesh.vertex_count, 0);
  for (const uint32_t e : level.curve_edges())
    if (mesh.kind[e] != EdgeKind::smooth)
      is_on_curve[mesh.origin[mesh.half_edge[e]]] = is_on_curve[mesh.tip(mesh.half_edge[e])] = 1;
  return is_on_curve;
}

}  // namespace

Buffer<Vec3f> residual_normals(const DetailLevel& level, const Vec3f* positions) {
  const Topology& mesh = level.topology();
  Buffer<Vec3f> at_vertex(mesh.vertex_count, Vec3f{});
  for (uint32_t f = 0; f < mesh.face_count(); ++f) {
    const Vec3f normal = area_normal(mesh, positions, f);
    for (uint32_t i = 0; i < 3; ++i) at_vertex[mesh.origin[size_t{3} * f + i]] += normal;
  }
  const Buffer<uint8_t> is_on_curve = vertices_on_curves(level);
  Buffer<Vec3f> normals = Buffer<Vec3f>::for_overwrite(mesh.edge_count());
  for (uint32_t e = 0; e < mesh.edge_count(); ++e) {
    const uint32_t h = mesh.half_edge[e];
    const uint32_t a = mesh.origin[h];
    const uint32_t b = mesh.tip(h);
    Vec3f sum;
    if (is_on_curve.empty() || (is_on_curve[a] == 0 && is_on_curve[b] == 0)) {
      sum = at_vertex[a] + at_vertex[b];
    } else {
      Vec3f at_edge = area_normal(mesh, positions, Topology::face(h));
      if (mesh.twin[h] != none) at_edge += area_normal(mesh, positions, Topology::face(mesh.twin[h]));
      sum = (is_on_curve[a] != 0 ? at_edge : at_vertex[a]) + (is_on_curve[b] != 0 ? at_edge : at_vertex[b]);
    }
    const float size = length(sum);
    normals[e] = size > 0 ? (1 / size) * sum : Vec3f{};
  }
  return normals;
}

Tangents residual_tangents(const Topology& level, const Vec3f* positions, uint32_t e, Vec3f normal) {
  const uint32_t h = level.half_edge[e];
  const Vec3f edge = positions[level.tip(h)] - positions[level.origin[h]];
  const Vec3f flat = edge - dot(edge, normal) * normal;
  const float size = length(flat);
  const Vec3f along = size > 0 ? (1 / size) * flat : Vec3f{};
  return {along, cross(normal, along)};
}

}  // namespace papilio
