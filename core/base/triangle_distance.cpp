#include "papilio/triangle_distance.h"

#include <algorithm>
#include <limits>

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
  const Vec3d ab = b - a;
  const Vec3d ac = c - a;
  const Vec3d normal = cross(ab, ac);
  const double u = dot(cross(c - b, point - b), normal);
  const double v = dot(cross(a - c, point - c), normal);
  const double w = dot(cross(ab, point - a), normal);
  const double sum = u + v + w;
  // Where the normal is more than rounding errors they tell whether the point lies above the inside, or else beyond
  // which sides: to one of these it is nearest.
  constexpr double least_sine_squared = 1e-8;
  const bool are_sure = sum > least_sine_squared * squared(ab) * squared(ac);
  const bool is_inside = u >= 0 && v >= 0 && w >= 0 && sum > 0;
  double least = std::numeric_limits<double>::infinity();
  // The foot on the plane is made of the corners, so that it lies on the triangle even if this is a sliver.
  if (is_inside) least = squared(point - (u / sum) * a - (v / sum) * b - (w / sum) * c);
  if (is_inside && are_sure) return least;
  if (!are_sure || u < 0) least = std::min(least, squared_distance_to_segment(point, b, c));
  if (!are_sure || v < 0) least = std::min(least, squared_distance_to_segment(point, c, a));
  if (!are_sure || w < 0) least = std::min(least, squared_distance_to_segment(point, a, b));
  return least;
}

}  // namespace papilio
