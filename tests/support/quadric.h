#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "papilio/vec3.h"

namespace papilio::test {

/// Weighted sum of squared distances to planes as a function of the point: x'Ax + 2b'x + c, A symmetric
/// (Garland and Heckbert 1997).
class Quadric {
 public:
  Quadric() = default;
  /// Squared distance to the plane through `point`, times `weight`. The normal has length one.
  Quadric(Vec3d normal, Vec3d point, double weight) {
    const double offset = -dot(normal, point);
    rows_ = {(weight * normal.x) * normal, (weight * normal.y) * normal, (weight * normal.z) * normal};
    linear_ = (weight * offset) * normal;
    constant_ = weight * offset * offset;
  }

  friend Quadric operator+(Quadric a, const Quadric& b) {
    for (size_t i = 0; i < 3; ++i) a.rows_[i] += b.rows_[i];
    a.linear_ += b.linear_;
    a.constant_ += b.constant_;
    return a;
  }

  [[nodiscard]] double at(Vec3d p) const {
    const Vec3d product{dot(rows_[0], p), dot(rows_[1], p), dot(rows_[2], p)};
    return std::max(dot(p, product) + 2 * dot(linear_, p) + constant_, 0.0);
  }

  /// Point of the least value, by Cramer's rule; nothing where the planes are too nearly parallel to one line.
  [[nodiscard]] std::optional<Vec3d> minimum() const {
    const Vec3d minors = cross(rows_[1], rows_[2]);
    const double determinant = dot(rows_[0], minors);
    const double mean = (rows_[0].x + rows_[1].y + rows_[2].z) / 3;
    if (!(determinant > least_determinant * mean * mean * mean)) return std::nullopt;
    const Vec3d adjugate =
        linear_.x * minors + linear_.y * cross(rows_[2], rows_[0]) + linear_.z * cross(rows_[0], rows_[1]);
    return (-1 / determinant) * adjugate;
  }

 private:
  /// Relative to that of a sphere's normals, 1.
  static constexpr double least_determinant = 1e-9;

  std::array<Vec3d, 3> rows_{};  ///< A
  Vec3d linear_{};               ///< b
  double constant_ = 0;          ///< c
};

}  // namespace papilio::test
