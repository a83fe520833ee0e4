#include "detail/residual_frames.h"

namespace papilio {

Buffer<Vec3f> residual_normals(const Topology& level, const Vec3f* positions) {
  Buffer<Vec3f> at_vertex(level.vertex_count, Vec3f{});
  for (uint32_t h = 0; h < level.half_edge_count(); h += 3) {
    const uint32_t* corner = &level.origin[h];
    const Vec3f a = positions[corner[0]];
    const Vec3f normal = cross(positions[corner[1]] - a, positions[corner[2]] - a);
    for (uint32_t i = 0; i < 3; ++i) at_vertex[corner[i]] += normal;
  }
  Buffer<Vec3f> normals = Buffer<Vec3f>::for_overwrite(level.edge_count());
  for (uint32_t e = 0; e < level.edge_count(); ++e) {
    const uint32_t h = level.half_edge[e];
    const Vec3f sum = at_vertex[level.origin[h]] + at_vertex[level.tip(h)];
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
