#pragma once

#include <algorithm>
#include <array>

#include "papilio/mesh.h"
#include "papilio/view.h"

namespace papilio {

/// Visibility and screen-size queries of a view. Throws `Error` bad_option, with the name of the field ("view.up"), if
/// the view does not define a picture.
class Camera {
 public:
  explicit Camera(const View& view);

  /// Returns whether the sphere lies outside one of the view's five planes (four sides, near): section 3.2.1.
  [[nodiscard]] bool is_outside(Vec3d centre, double radius) const {
    return std::ranges::any_of(planes_,
                               [&](const Plane& plane) { return dot(plane.normal, centre) - plane.offset < -radius; });
  }
  /// Returns whether a face through `point` with unit normal `normal` is turned away from the viewer: section 3.2.2. In
  /// a perspective projection, the direction to the point replaces the view direction.
  [[nodiscard]] bool is_away(Vec3d point, Vec3d normal) const {
    const Vec3d sight = sight_to(point);
    const double along = dot(sight, normal);
    return along > 0 && along * along > away_epsilon * away_epsilon * dot(sight, sight);
  }
  /// Returns whether faces are visible from behind, so that none is culled as turned away.
  [[nodiscard]] bool shows_backs() const { return two_sided_; }
  /// Returns whether a face through `point` with a normal of any length is turned to the viewer.
  [[nodiscard]] bool is_towards(Vec3d point, Vec3d normal) const { return dot(sight_to(point), normal) < 0; }
  /// Returns the cosine of the angle between the unit normal and the direction to the viewer: 1 if seen from the front.
  [[nodiscard]] double facing(Vec3d point, Vec3d normal) const;
  /// Returns the length in pixels of the projected segment, clipped at the near plane, but not at the sides.
  [[nodiscard]] double projected_length(Vec3d a, Vec3d b) const;
  /// Returns the pixels per unit of length across the line of sight at the point, clamped to the near plane.
  [[nodiscard]] double pixels_per_unit(Vec3d point) const { return pixels_per_unit_at(dot(forward_, point - eye_)); }
  /// Returns an upper bound of pixels_per_unit() in the box.
  [[nodiscard]] double highest_pixels_per_unit(const Box& box) const;

 private:
  struct Plane {
    Vec3d normal;   ///< unit normal, pointing inward
    double offset;  ///< distance from the origin: a point p is inside if normal.p >= offset
  };
  [[nodiscard]] Vec3d sight_to(Vec3d point) const { return perspective_ ? point - eye_ : forward_; }
  [[nodiscard]] std::array<double, 2> project(Vec3d relative) const;
  [[nodiscard]] double pixels_per_unit_at(double depth) const {
    return std::min(most_pixels_per_unit, perspective_ ? pixels_per_unit_ / std::max(near_, depth) : pixels_per_unit_);
  }

  /// Small positive number of section 3.2.2: the sine of the angle past edge-on from which a face is turned away.
  static constexpr double away_epsilon = 1e-3;
  /// Upper bound of pixels_per_unit() for any near plane, so that products stay finite.
  static constexpr double most_pixels_per_unit = 1e200;

  bool perspective_, two_sided_;
  Vec3d eye_, right_, up_, forward_;
  double near_;
  double pixels_per_unit_;  ///< scale at distance 1 (perspective) or at any distance (orthographic)
  std::array<Plane, 5> planes_;
};

}  // namespace papilio
