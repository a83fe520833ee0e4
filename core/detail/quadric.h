#pragma once

#include <optional>

#include "papilio/vec3.h"

namespace papilio {

/// Weighted sum of squared distances to planes, as a function of a point [Garland, Heckbert 1997].
class Quadric {
 public:
  Quadric() = default;
  /// Makes the squared distance to the plane through `point` with the unit `normal`, times `weight`.
  Quadric(Vec3d normal, Vec3d point, double weight) {
    const double offset = -dot(normal, point);
    xx_ = weight * normal.x * normal.x;
    xy_ = weight * normal.x * normal.y;
    xz_ = weight * normal.x * normal.z;
    yy_ = weight * normal.y * normal.y;
    yz_ = weight * normal.y * normal.z;
    zz_ = weight * normal.z * normal.z;
    linear_ = (weight * offset) * normal;
    constant_ = weight * offset * offset;
  }

  Quadric& operator+=(const Quadric& b) {
    xx_ += b.xx_, xy_ += b.xy_, xz_ += b.xz_, yy_ += b.yy_, yz_ += b.yz_, zz_ += b.zz_;
    linear_ += b.linear_;
    constant_ += b.constant_;
    return *this;
  }

  friend Quadric operator+(Quadric a, const Quadric& b) { return a += b; }
  /// Returns the value at p; never negative.
  [[nodiscard]] double at(Vec3d p) const {
    const Vec3d product{xx_ * p.x + xy_ * p.y + xz_ * p.z, xy_ * p.x + yy_ * p.y + yz_ * p.z,
                        xz_ * p.x + yz_ * p.y + zz_ * p.z};
    const double value = dot(p, product) + 2 * dot(linear_, p) + constant_;
    return value > 0 ? value : 0;
  }

  /// Returns the point of the least value, by Cramer's rule; nothing if the planes are nearly parallel to one line.
  [[nodiscard]] std::optional<Vec3d> minimum() const {
    const Vec3d x{xx_, xy_, xz_}, y{xy_, yy_, yz_}, z{xz_, yz_, zz_};
    const Vec3d minors = cross(y, z);
    const double determinant = dot(x, minors);
    const double mean = (xx_ + yy_ + zz_) / 3;
    if (!(determinant > least_determinant * mean * mean * mean)) return std::nullopt;
    const Vec3d adjugate = linear_.x * minors + linear_.y * cross(z, x) + linear_.z * cross(x, y);
    return (-1 / determinant) * adjugate;
  }

 private:
  static constexpr double least_determinant = 1e-9;  ///< lower bound; a sphere's normals have 1

  double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0;
  Vec3d linear_{};
  double constant_ = 0;
};

}  // namespace papilio
