#pragma once

#include <cmath>

#include "papilio/mesh.h"

namespace papilio::test {

/// Rounds positions as Draco's decoder returns them: to whole steps from the lowest corner, in single precision.
[[nodiscard]] inline Buffer<Vec3f> on_grid(Buffer<Vec3f> points, double step) {
  const Box box = bounding_box(points);
  const auto spacing = static_cast<float>(step);
  const auto round = [&](float& at, float low) { at = low + spacing * std::round((at - low) / spacing); };
  for (Vec3f& p : points) {
    round(p.x, box.min.x);
    round(p.y, box.min.y);
    round(p.z, box.min.z);
  }
  return points;
}

/// Returns the length of the longest side of the points' box.
[[nodiscard]] inline double longest_side(const Buffer<Vec3f>& points) {
  const Box box = bounding_box(points);
  const Vec3d size = to_double(box.max) - to_double(box.min);
  return std::fmax(size.x, std::fmax(size.y, size.z));
}

}  // namespace papilio::test
