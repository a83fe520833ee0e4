#include "tests/support/seen_distance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "client/lib/surface_distance.h"
#include "criteria/camera.h"
#include "tests/support/two_sided_distance.h"

namespace papilio::test {
namespace {

using client::SurfaceDistance;

/// Calls `visit` with samples of the faces that the camera sees.
template <class Visit>
void visit_seen(const std::vector<TriangleCorners>& faces, const Camera& camera, const Visit& visit) {
  for (const TriangleCorners& face : faces) {
    const Vec3d normal = cross(face.b - face.a, face.c - face.a);
    if (!(length(normal) > 0) || (!camera.shows_backs() && camera.is_away(face.a, 1 / length(normal) * normal)))
      continue;
    for (const Vec3d& sample : samples_of(face))
      if (!camera.is_outside(sample, 0)) visit(sample);
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
