#pragma once

#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// Unit normal of each face [F]; zero for a face without area, which has none. Computed in double, so that
/// neither tiny nor large meshes lose theirs. Up to so many threads work on it. Where faces come by fours
/// (split_in_four.h), only some fours may be asked about, by number: the other normals mean nothing then.
[[nodiscard]] Buffer<Vec3f> face_normals(const Mesh& mesh, int threads = 1, const Buffer<uint32_t>* fours = nullptr);

/// Products of two unit normals in float are off by up to about this: two faces in one plane have 1 - 2e-7, say.
inline constexpr double product_rounding = 4e-7;

/// Normal of a face, as long as twice its area.
[[nodiscard]] inline Vec3d area_normal(const Mesh& mesh, uint32_t f) {
  const uint32_t* corner = &mesh.topology.origin[size_t{3} * f];
  const Vec3d a = to_double(mesh.positions[corner[0]]);
  return cross(to_double(mesh.positions[corner[1]]) - a, to_double(mesh.positions[corner[2]]) - a);
}

[[nodiscard]] inline bool has_normal(Vec3f n) { return n != Vec3f{}; }

}  // namespace papilio
