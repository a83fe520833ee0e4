#include "triangle_distance.h"

#include <algorithm>

namespace papilio {
namespace {

double squared(Vec3d a) { return dot(a, a); }

}  // namespace

double squared_distance_to_segment(Vec3d point, Vec3d a, Vec3d b) {
  const Vec3d along = b - a;
  const double length_squared = squared(along);
  const double t = length_squared > 0 ? std::clamp(dot(point - a, along) / length_squared, 0.0, 1.0) : 0.0;
  return squared(point - a - t * along);
}

double squared_distance(Vec3d point, const TriangleCorners& triangle) {
  const auto& [a, b, c] = triangle;
  const Vec3d normal = cross(b - a, c - a);
  double least = std::min({squared_distance_to_segment(point, a, b), squared_distance_to_segment(point, b, c),
                           squared_distance_to_segment(point, c, a)});
  // Where the point lies above the inside, its foot on the plane. The foot is made of the corners, so that it
  // lies on the triangle even if this is a sliver whose normal is nothing but rounding errors.
  const double u = dot(cross(c - b, point - b), normal);
  const double v = dot(cross(a - c, point - c), normal);
  const double w = dot(cross(b - a, point - a), normal);
  const double sum = u + v + w;
  if (u >= 0 && v >= 0 && w >= 0 && sum > 0)
    least = std::min(least, squared(point - (u / sum) * a - (v / sum) * b - (w / sum) * c));
  return least;
}

}  // namespace papilio
