#include "detail/folds.h"

namespace papilio {

bool is_fold(const OriginalSurface& original, const TriangleCorners& face, double reach) {
  const auto& [a, b, c] = face;
  const Vec3d centre = (1 / 3.0) * (a + b + c);
  const Vec3d across = cross(b - a, c - a);
  const double size = length(across);
  const Vec3d normal = size > 0 ? (1 / size) * across : Vec3d{};
  const Nearest near = original.tree().nearest(centre);
  return dot(normal, original.tree().unit_normal(near.face)) <= 0 &&
         dot(normal, original.normal(near.face, near.point)) <= 0 &&
         (normal == Vec3d{} || original.tree().nearest(centre, reach, normal).face == none);
}

Folds find_folds(const OriginalSurface& original, const SurfaceTree& surface, double reach, const Poller& poller) {
  Folds folds;
  double area = 0;
  for (uint32_t f = 0; f < surface.surface().triangles.size(); ++f) {
    poller.step();
    const TriangleCorners face = surface.corners(f);
    const double of_face = length(cross(face.b - face.a, face.c - face.a));
    area += of_face;
    if (!is_fold(original, face, reach)) continue;
    ++folds.faces;
    folds.area += of_face;
  }
  if (area > 0) folds.area /= area;
  return folds;
}

}  // namespace papilio
