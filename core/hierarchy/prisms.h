#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "hierarchy/result_surface.h"

// Triangles near points, at a fraction of the cost of squared_distance() (papilio/triangle_distance.h).

namespace papilio {

/// Triangle prepared for tests of points near it.
class Prism {
 public:
  explicit Prism(const TriangleCorners& triangle) : corner_{triangle.a, triangle.b, triangle.c} {
    constexpr double least_sine_squared = 1e-8;  // of less the normal may be mere rounding error
    const Vec3d ab = triangle.b - triangle.a, ac = triangle.c - triangle.a;
    const Vec3d area = cross(ab, ac);
    const double squared_size = dot(area, area);
    if (!(squared_size > least_sine_squared * dot(ab, ab) * dot(ac, ac))) return;
    normal_ = 1 / std::sqrt(squared_size) * area;
    for (uint32_t i = 0; i < 3; ++i) {
      const Vec3d side = corner_[(i + 1) % 3] - corner_[i];
      inward_[i] = cross(normal_, side);
      squared_side_[i] = dot(side, side);
    }
  }

  /// Returns whether a point is within the root of `enough` of the triangle. Then `squared` becomes the squared
  /// distance; else it is undefined.
  [[nodiscard]] bool is_within(Vec3d point, double enough, double& squared) const {
    const double above = dot(point - corner_[0], normal_);
    squared = above * above;
    if (squared > enough) return false;
    bool is_inside = true;
    for (uint32_t i = 0; i < 3; ++i) {
      const double inside = dot(point - corner_[i], inward_[i]);  // times the side's length
      if (inside > 0) continue;
      if (inside * inside > (enough - squared) * squared_side_[i]) return false;
      is_inside = false;
    }
    if (!is_inside) squared = squared_distance(point, {corner_[0], corner_[1], corner_[2]});
    return squared <= enough;
  }
  /// Returns at what share of the way from a point above or below the triangle to another the way leaves the prism; 1
  /// if it does not.
  [[nodiscard]] double end_above(Vec3d from, Vec3d to) const {
    double end = 1;
    for (uint32_t i = 0; i < 3; ++i) {
      const double first = dot(from - corner_[i], inward_[i]);
      const double last = dot(to - corner_[i], inward_[i]);
      if (first > 0 && last < 0) end = std::min(end, first / (first - last));
    }
    return end;
  }

 private:
  Corners corner_;
  Vec3d normal_{};    ///< of length one; zero of a triangle nearly without area
  Corners inward_{};  ///< normals of the sides in the triangle's plane, as long as the sides
  std::array<double, 3> squared_side_{};
};

/// Point of one surface, and a triangle of the other near it.
struct PointNear {
  Vec3d point;
  double squared;  ///< upper bound of the squared distance from the other surface; from the triangle, if known
  uint32_t triangle = none;  ///< its number among prisms; `none` if it is not known
};

/// Triangles of a surface that were near points so far, by number.
class Prisms {
 public:
  void clear() { prisms_.clear(); }
  /// Returns the number of the new triangle.
  uint32_t add(const TriangleCorners& triangle) {
    prisms_.emplace_back(triangle);
    return size() - 1;
  }
  [[nodiscard]] uint32_t size() const { return static_cast<uint32_t>(prisms_.size()); }
  [[nodiscard]] const Prism& operator[](uint32_t number) const { return prisms_[number]; }

  /// Returns the point with the first triangle from `first` on within the root of `enough`, if there is one.
  [[nodiscard]] PointNear find(Vec3d point, double enough, uint32_t first = 0) const {
    for (uint32_t i = first; i < size(); ++i)
      if (double squared = 0; prisms_[i].is_within(point, enough, squared)) return {point, squared, i};
    return {point, std::numeric_limits<double>::infinity()};
  }
  /// Returns whether a triangle is within the root of `enough` of a point.
  [[nodiscard]] bool is_near(uint32_t triangle, const PointNear& point, double enough) const {
    double squared = 0;
    return (triangle == point.triangle && point.squared <= enough) ||
           prisms_[triangle].is_within(point.point, enough, squared);
  }

 private:
  std::vector<Prism> prisms_;
};

}  // namespace papilio
