#pragma once

#include "papilio/vec3.h"

namespace papilio {

struct TriangleCorners {
  Vec3d a, b, c;
};

/// The distance squared from a point to the nearest point of a segment; of one without length, to its end.
[[nodiscard]] double squared_distance_to_segment(Vec3d point, Vec3d a, Vec3d b);

/// The distance squared from a point to the nearest point of a triangle, its border included. A degenerate
/// triangle is the segment or the point that it covers. Christer Ericson, Real-Time Collision Detection
/// (2005), 5.1.
[[nodiscard]] double squared_distance(Vec3d point, const TriangleCorners& triangle);

}  // namespace papilio
