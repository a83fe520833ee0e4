#pragma once

#include <vector>

#include "base/ids.h"
#include "papilio/mesh.h"

namespace papilio {

/// Returns [F] the unit normal of each face; zero for a face without area. Computes in double, so that tiny and large
/// meshes keep their normals. Uses at most `threads` threads.
[[nodiscard]] Buffer<Vec3f> face_normals(const Mesh& mesh, int threads = 1);

/// Approximate bound of the error of a dot product of two unit normals in float. Two faces in one plane may have 1 -
/// 2e-7.
inline constexpr double product_rounding = 4e-7;

/// Returns the normal of a face, as long as twice its area.
[[nodiscard]] inline Vec3d area_normal(const Mesh& mesh, FaceId f) {
  const uint32_t* corner = &mesh.topology.origin[size_t{3} * f];
  const Vec3d a = to_double(mesh.positions[corner[0]]);
  return cross(to_double(mesh.positions[corner[1]]) - a, to_double(mesh.positions[corner[2]]) - a);
}

[[nodiscard]] inline bool has_normal(Vec3f n) { return n != Vec3f{}; }

}  // namespace papilio
