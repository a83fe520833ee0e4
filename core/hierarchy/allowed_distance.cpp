#include "hierarchy/allowed_distance.h"

#include <algorithm>
#include <cmath>

#include "hierarchy/patch.h"

namespace papilio {
namespace {

/// Of length one; 0 of a triangle without area.
Vec3d unit_normal(const Corners& corner) {
  const Vec3d area = cross(corner[1] - corner[0], corner[2] - corner[0]);
  const double size = length(area);
  return size > 0 ? 1 / size * area : Vec3d{};
}

/// The largest number of pixels per unit at a face if the picture may show any of it, of its pieces, or of what lies
/// below; else 0. The normals of all these are taken to be no further from its own than three times those of its
/// children are.
double scale_at(const LevelChoice& choice, uint32_t face, const Camera& camera) {
  constexpr double all_turns = 3;
  const Corners corner = corners_of(choice, face);
  const Corners made = new_vertices_of(choice, face, corner);
  const Vec3d centre = 1.0 / 3 * (corner[0] + corner[1] + corner[2]);
  double squared_radius = 0, scale = 0;
  for (const Corners* points : {&corner, &made})
    for (const Vec3d& p : *points) {
      squared_radius = std::max(squared_radius, squared_norm(p - centre));
      scale = std::max(scale, camera.pixels_per_unit(p));
    }
  if (camera.is_outside(centre, std::sqrt(squared_radius))) return 0;
  const Vec3d normal = unit_normal(corner);
  const double facing = camera.facing(centre, normal);
  if (facing >= 0) return scale;
  double turn = 0;
  for (const Corners& child : children_of(corner, made))
    turn = std::max(turn, squared_norm(unit_normal(child) - normal));
  return -facing <= all_turns * std::sqrt(turn) ? scale : 0;
}

}  // namespace

Buffer<float> DistanceLimit::at_faces(const LevelChoice& choice) const {
  Buffer<float> limits(choice.level->mesh.topology.face_count(), static_cast<float>(everywhere));
  if (camera == nullptr) return limits;
  for (uint32_t f : choice.region.faces) {
    const double scale = scale_at(choice, f, *camera);
    limits[f] = static_cast<float>(scale > 0 ? std::max(everywhere, pixels / scale) : AllowedDistance::any);
  }
  return limits;
}

AllowedDistance::AllowedDistance(std::span<const LevelChoice> levels, const DistanceLimit& limit)
    : at_(levels.size()), least_(any) {
  for (size_t k = levels.size(); k-- > 0;) {
    const LevelChoice& choice = levels[k];
    at_[k] = limit.at_faces(choice);
    for (uint32_t f : choice.region.faces) {
      if (k + 1 < levels.size() && choice.red[f] != 0) {
        const float* below = &at_[k + 1][levels[k + 1].level->first_child_of(f)];
        at_[k][f] = std::min({at_[k][f], below[0], below[1], below[2], below[3]});
      }
      least_ = std::min<double>(least_, at_[k][f]);
    }
  }
}

}  // namespace papilio
