#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "papilio/mesh.h"
#include "papilio/view.h"

namespace papilio {

/// The view made ready for questions. Throws `Error` bad_option, naming the field ("view.up"), when the view
/// does not define a picture.
class Camera {
 public:
  explicit Camera(const View& view);

  struct Plane {
    Vec3d normal;   ///< unit, inward
    double offset;  ///< a point p is inside when normal.p >= offset
  };
  /// True when the sphere round `centre` lies outside of one of the planes.
  [[nodiscard]] static bool is_outside(std::span<const Plane> planes, Vec3d centre, double radius) {
    for (const Plane& plane : planes)
      if (dot(plane.normal, centre) - plane.offset < -radius) return true;
    return false;
  }
  /// Tells that of all five planes (four sides, near): section 3.2.1.
  [[nodiscard]] bool is_outside(Vec3d centre, double radius) const { return is_outside(planes_, centre, radius); }
  /// True when a face with unit normal `normal`, `point` being on it, is turned away from the viewer:
  /// section 3.2.2, with the direction to the face in place of the one view direction where the projection is
  /// perspective.
  [[nodiscard]] bool is_away(Vec3d point, Vec3d normal) const {
    const Vec3d sight = sight_to(point);
    const double along = dot(sight, normal);
    return along > 0 && along * along > away_epsilon * away_epsilon * dot(sight, sight);
  }
  /// Whether faces are shown from behind too: then none is hidden for being turned away.
  [[nodiscard]] bool shows_backs() const { return two_sided_; }
  /// True when it is turned to the viewer, by a normal of any length.
  [[nodiscard]] bool is_towards(Vec3d point, Vec3d normal) const { return dot(sight_to(point), normal) < 0; }
  /// Cosine of the angle between the unit normal and the way from the point to the viewer: 1 when seen from the front.
  [[nodiscard]] double facing(Vec3d point, Vec3d normal) const;
  /// Length in pixels of the segment's picture, clipped at the near plane, not at the sides.
  [[nodiscard]] double projected_length(Vec3d a, Vec3d b) const;
  /// Whether that is less than `pixels`.
  [[nodiscard]] bool looks_shorter(Vec3d a, Vec3d b, double pixels) const;
  /// Pixels that a short piece of length 1 at the point covers when seen from its side; nearer than the near plane, as
  /// on it.
  [[nodiscard]] double pixels_per_unit(Vec3d point) const { return pixels_per_unit_at(dot(forward_, point - eye_)); }
  /// No less than that of any point in the box.
  [[nodiscard]] double highest_pixels_per_unit(const Box& box) const;
  /// Those of the five planes inside of which not all of the box is certain to be.
  [[nodiscard]] std::vector<Plane> planes_through(const Box& box) const;

 private:
  [[nodiscard]] Vec3d sight_to(Vec3d point) const { return perspective_ ? point - eye_ : forward_; }
  [[nodiscard]] std::array<double, 2> project(Vec3d relative) const;
  [[nodiscard]] std::array<double, 2> projected_difference(Vec3d a, Vec3d b) const;
  [[nodiscard]] double pixels_per_unit_at(double depth) const {
    return std::min(most_pixels_per_unit, perspective_ ? pixels_per_unit_ / std::max(near_, depth) : pixels_per_unit_);
  }

  /// The small positive number of section 3.2.2: the sine of the angle by which a face must be turned past
  /// edge-on.
  static constexpr double away_epsilon = 1e-3;
  /// However near the near plane is: what it is multiplied by stays a number.
  static constexpr double most_pixels_per_unit = 1e200;

  bool perspective_, two_sided_;
  Vec3d eye_, right_, up_, forward_;
  double near_;
  double pixels_per_unit_;  ///< at distance 1 (perspective) or at any (orthographic)
  std::array<Plane, 5> planes_;
};

}  // namespace papilio
