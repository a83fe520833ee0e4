#pragma once

#include "papilio/vec3.h"

namespace papilio {

struct TriangleCorners {
  Vec3d a, b, c;
  friend bool operator==(const TriangleCorners&, const TriangleCorners&) = default;
};

/// Returns the squared distance from a point to a segment, which may have no length.
[[nodiscard]] double squared_distance_to_segment(Vec3d point, Vec3d a, Vec3d b);

/// Returns the squared distance from a point to a triangle, its border included. A degenerate triangle is the segment
/// or point that it covers. Source: Christer Ericson, Real-Time Collision Detection (2005), 5.1.
[[nodiscard]] double squared_distance(Vec3d point, const TriangleCorners& triangle);

}  // namespace papilio
