#include "tests/support/seen_distance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "client/lib/surface_distance.h"
#include "criteria/camera.h"

namespace papilio::test {
namespace {

using client::SurfaceDistance;

std::vector<TriangleCorners> corners_of(const Mesh& mesh) {
  std::vector<TriangleCorners> all;
  all.reserve(mesh.topology.face_count());
  const auto at = [&](uint32_t h) { return to_double(mesh.positions[mesh.topology.origin[h]]); };
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); h += 3) all.push_back({at(h), at(h + 1), at(h + 2)});
  return all;
}

/// Calls `visit` with samples of the faces that the camera sees.
template <class Visit>
void visit_seen(const std::vector<TriangleCorners>& faces, const Camera& camera, const Visit& visit) {
  constexpr int steps = 4;
  for (const auto& [a, b, c] : faces) {
    const Vec3d normal = cross(b - a, c - a);
    if (!(length(normal) > 0) || camera.is_away(a, 1 / length(normal) * normal)) continue;
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j) {
        const double u = static_cast<double>(i) / steps;
        const double v = static_cast<double>(j) / steps;
        const Vec3d sample = (1 - u - v) * a + u * b + v * c;
        if (!camera.is_outside(sample, 0)) visit(sample);
      }
  }
}

}  // namespace

SeenDistance seen_distance(const Mesh& adaptive, const Mesh& uniform, const View& view) {
  const Camera camera(view);
  const std::vector<TriangleCorners> faces = corners_of(adaptive);
  const std::vector<TriangleCorners> uniform_faces = corners_of(uniform);
  const SurfaceDistance to_adaptive(faces);
  const SurfaceDistance to_uniform(uniform_faces);
  SeenDistance found;
  visit_seen(uniform_faces, camera, [&](Vec3d sample) {
    found.to_adaptive = std::max(found.to_adaptive, to_adaptive.distance(sample) * camera.pixels_per_unit(sample));
  });
  visit_seen(faces, camera, [&](Vec3d sample) {
    found.to_uniform = std::max(found.to_uniform, to_uniform.distance(sample) * camera.pixels_per_unit(sample));
  });
  return found;
}

}  // namespace papilio::test
