#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "papilio/mesh.h"
#include "papilio/view.h"
#include "simd/float4.h"

namespace papilio {

/// The view made ready for questions. Throws `Error` bad_option, naming the field ("view.up"), when the view
/// does not define a picture.
class Camera {
 public:
  explicit Camera(const View& view);

  /// True when the sphere round `centre` lies outside of one of the five planes (four sides, near):
  /// section 3.2.1.
  [[nodiscard]] bool is_outside(Vec3d centre, double radius) const { return is_outside(centre, radius, all_planes); }
  /// The same, of the planes in a set.
  [[nodiscard]] bool is_outside(Vec3d centre, double radius, unsigned planes) const;
  /// True when a face with unit normal `normal`, `point` being on it, is turned away from the viewer:
  /// section 3.2.2, with the direction to the face in place of the one view direction where the projection is
  /// perspective.
  [[nodiscard]] bool is_away(Vec3d point, Vec3d normal) const;
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
  /// The set (bits) of those of the five planes inside of which not all of the box is certain to be.
  [[nodiscard]] unsigned planes_through(const Box& box) const;
  enum class Answer : uint8_t { no, yes, unsure };
  /// Decides most of `is_away`, of four faces in the box at once.
  class QuickAway;
  /// Decides most of `is_outside`, of four planes at once, for points in the box.
  class QuickOutside;

 private:
  struct Plane {
    Vec3d normal;   ///< unit, inward
    double offset;  ///< a point p is inside when normal.p >= offset
  };
  [[nodiscard]] std::array<double, 2> project(Vec3d relative) const;
  [[nodiscard]] std::array<double, 2> projected_difference(Vec3d a, Vec3d b) const;
  [[nodiscard]] double pixels_per_unit_at(double depth) const {
    return std::min(most_pixels_per_unit, perspective_ ? pixels_per_unit_ / std::max(near_, depth) : pixels_per_unit_);
  }

  /// However near the near plane is: what it is multiplied by stays a number.
  static constexpr double most_pixels_per_unit = 1e200;
  static constexpr unsigned all_planes = 31, near_plane = 4;

  bool perspective_;
  Vec3d eye_, right_, up_, forward_;
  double near_;
  double pixels_per_unit_;  ///< at distance 1 (perspective) or at any (orthographic)
  std::array<Plane, 5> planes_;
};

class Camera::QuickAway {
 public:
  QuickAway(const Camera& camera, const Box& box);
  struct FourAnswers {
    Mask4 no, yes;
  };
  /// `planes`: the products of the unit normals with points of the faces. Nothing is decided where a float could not
  /// hold what the eye is away.
  [[nodiscard]] FourAnswers operator()(const Vec3x4& normals, Float4 planes) const {
    const Float4 along = perspective_ * planes - (from_.x * normals.x + from_.y * normals.y + from_.z * normals.z);
    const Mask4 no = along < surely_towards_;
    const Mask4 yes = along > surely_away_;
    return {no, yes};
  }

 private:
  float perspective_;  ///< 1 or 0
  Vec3f from_;
  float surely_towards_, surely_away_;
};

class Camera::QuickOutside {
 public:
  /// Of the planes in the set; with the near plane among them nothing is decided, nor where floats could not hold it.
  QuickOutside(const Camera& camera, const Box& box, unsigned planes);
  [[nodiscard]] Answer operator()(Vec3f centre, float radius) const {
    if (!is_certain_) return Answer::unsure;
    const Float4 distance = centre.x * normals_.x + centre.y * normals_.y + centre.z * normals_.z - offsets_;
    if (!is_any(distance < margin_ - radius)) return Answer::no;
    return is_any(distance < -margin_ - radius) ? Answer::yes : Answer::unsure;
  }

 private:
  Vec3x4 normals_;  ///< of the sides; zero where a plane is not in the set, and the offset is far below
  Float4 offsets_;
  float margin_;  ///< more than rounding makes of a distance
  bool is_certain_;
};

}  // namespace papilio
