#pragma once

#include <algorithm>

#include "hierarchy/result_surface.h"

// Distances of points near triangles, at a fraction of the cost of squared_distance() (papilio/triangle_distance.h).

namespace papilio {

/// Triangle prepared for tests of points near it.
class Prism {
 public:
  explicit Prism(const TriangleCorners& triangle) : corner_{triangle.a, triangle.b, triangle.c} {
    const Vec3d area = cross(triangle.b - triangle.a, triangle.c - triangle.a);
    const double size = length(area);
    if (!(size > 0)) return;
    normal_ = 1 / size * area;
    for (uint32_t i = 0; i < 3; ++i) inward_[i] = cross(normal_, corner_[(i + 1) % 3] - corner_[i]);
  }

  /// Returns whether a point is within the root of `enough` of the triangle. Then `squared` becomes the squared
  /// distance.
  [[nodiscard]] bool is_within(Vec3d point, double enough, double& squared) const {
    const double above = dot(point - corner_[0], normal_);
    const double height = above * above;
    if (height > enough) return false;
    const double distance = is_inside(point) ? height : squared_distance(point, {corner_[0], corner_[1], corner_[2]});
    if (distance > enough) return false;
    squared = distance;
    return true;
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
  [[nodiscard]] bool is_inside(Vec3d point) const {
    return is_inside(point, 0) && is_inside(point, 1) && is_inside(point, 2);
  }
  [[nodiscard]] bool is_inside(Vec3d point, uint32_t i) const { return dot(point - corner_[i], inward_[i]) > 0; }

  Corners corner_;
  Vec3d normal_{};    ///< of length one; zero of a triangle without area
  Corners inward_{};  ///< normals of the sides in the triangle's plane
};

}  // namespace papilio
