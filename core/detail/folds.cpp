#include "detail/folds.h"

namespace papilio {

uint32_t count_folds(const OriginalSurface& original, const SurfaceTree& surface, double reach) {
  uint32_t folds = 0;
  for (uint32_t f = 0; f < surface.surface().triangles.size(); ++f) {
    const auto [a, b, c] = surface.corners(f);
    const Vec3d centre = (1 / 3.0) * (a + b + c);
    const Nearest near = original.tree().nearest(centre);
    const Vec3d normal = surface.unit_normal(f);
    if (dot(normal, original.tree().unit_normal(near.face)) <= 0 &&
        dot(normal, original.normal(near.face, near.point)) <= 0 &&
        (normal == Vec3d{} || original.tree().nearest(centre, reach, normal).face == none))
      ++folds;
  }
  return folds;
}

}  // namespace papilio
