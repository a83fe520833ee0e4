#include "hierarchy/allowed_distance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hierarchy/patch.h"
#include "simd/extremes.h"
#include "split/split_pattern.h"

namespace papilio {
namespace {

/// Returns a triangle's normal, of the length of twice its area.
Vec3d area_normal(Vec3d a, Vec3d b, Vec3d c) { return cross(b - a, c - a); }

/// Returns a triangle's unit normal; 0 if it has no area.
Vec3d unit_normal(const Corners& corner) {
  const Vec3d area = area_normal(corner[0], corner[1], corner[2]);
  const double size = length(area);
  return size > 0 ? 1 / size * area : Vec3d{};
}

/// Returns whether any triangle that a transition face may be cut into faces the viewer.
bool has_piece_towards(const Corners& corner, const Corners& made, const Camera& camera) {
  const std::array<Vec3d, 6> point{corner[0], corner[1], corner[2], made[0], made[1], made[2]};
  return std::any_of(split_patterns.begin() + 2, split_patterns.end() - 2, [&](const SplitPattern& cut) {
    return std::any_of(cut.corner.begin(), cut.corner.begin() + cut.children, [&](const auto& c) {
      return camera.is_towards(point[c[0]], area_normal(point[c[0]], point[c[1]], point[c[2]]));
    });
  });
}

/// Returns the most pixels per unit at a face; 0 if the picture shows neither the face nor its pieces nor its
/// descendants, whose normals are assumed to differ from its own by at most three times as much as its children's.
double scale_at(const LevelChoice& choice, FaceId face, const Camera& camera) {
  constexpr double all_turns = 3;
  const Corners corner = corners_of(choice, face);
  const Corners made = new_vertices_of(choice, face, corner);
  const Vec3d centre = 1.0 / 3 * (corner[0] + corner[1] + corner[2]);
  double squared_radius = 0, scale = 0;
  for (const Corners* points : {&corner, &made})
    for (const Vec3d& p : *points) {
      squared_radius = larger(squared_radius, squared_norm(p - centre));
      scale = larger(scale, camera.pixels_per_unit(p));
    }
  if (camera.is_outside(centre, std::sqrt(squared_radius))) return 0;
  if (camera.shows_backs()) return scale;
  const Vec3d normal = unit_normal(corner);
  const double facing = camera.facing(centre, normal);
  if (facing >= 0) return scale;
  double turn = 0;
  for (const Corners& child : children_of(corner, made)) turn = larger(turn, squared_norm(unit_normal(child) - normal));
  return -facing <= all_turns * std::sqrt(turn) || has_piece_towards(corner, made, camera) ? scale : 0;
}

}  // namespace

Buffer<float> DistanceLimit::at_faces(const LevelChoice& choice) const {
  Buffer<float> limits(choice.level->mesh.topology.face_count(), static_cast<float>(everywhere));
  if (camera == nullptr) return limits;
  for (FaceId f : choice.region.faces) {
    const double scale = scale_at(choice, f, *camera);
    limits[f] = static_cast<float>(scale > 0 ? larger(everywhere, pixels / scale) : AllowedDistance::any);
  }
  return limits;
}

AllowedDistance::AllowedDistance(std::span<const LevelChoice> levels, const DistanceLimit& limit)
    : at_(levels.size()), least_(any) {
  for (size_t k = levels.size(); k-- > 0;) {
    const LevelChoice& choice = levels[k];
    at_[k] = limit.at_faces(choice);
    for (FaceId f : choice.region.faces) {
      if (k + 1 < levels.size() && choice.red[f] != 0) {
        const float* below = &at_[k + 1][levels[k + 1].level->first_child_of(f)];
        at_[k][f] = lesser(at_[k][f], below[0], below[1], below[2], below[3]);
      }
      least_ = lesser(least_, double{at_[k][f]});
    }
  }
}

}  // namespace papilio
