#include "papilio/triangle_distance.h"

#include <limits>

#include "simd/extremes.h"

namespace papilio {
namespace {

double squared(Vec3d a) { return dot(a, a); }

}  // namespace

double squared_distance_to_segment(Vec3d point, Vec3d a, Vec3d b) {
  const Vec3d along = b - a;
  const double length_squared = squared(along);
  const double t = length_squared > 0 ? lesser(larger(dot(point - a, along) / length_squared, 0.0), 1.0) : 0.0;
  return squared(point - a - t * along);
}

double squared_distance(Vec3d point, const TriangleCorners& triangle) {
  const auto& [a, b, c] = triangle;
  const Vec3d ab = b - a;
  const Vec3d ac = c - a;
  const Vec3d from_a = point - a;
  const Vec3d normal = cross(ab, ac);
  const double whole = squared(normal);
  // Barycentric coordinates, times `whole`.
  const double v = dot(cross(from_a, ac), normal);
  const double w = dot(cross(ab, from_a), normal);
  const double u = whole - v - w;
  // Unless the normal is mere rounding error, they show whether the foot is inside, or beyond which sides; one of those
  // sides is then nearest.
  constexpr double least_sine_squared = 1e-8;
  const bool are_sure = whole > least_sine_squared * squared(ab) * squared(ac);
  const bool is_inside = u >= 0 && v >= 0 && w >= 0 && whole > 0;
  if (is_inside && are_sure) {
    const double height = dot(from_a, normal);
    return height * height / whole;
  }
  double least = std::numeric_limits<double>::infinity();
  // The foot is computed from the corners, so that it lies on the triangle even if this is a sliver.
  if (is_inside) least = squared(from_a - (v / whole) * ab - (w / whole) * ac);
  if (!are_sure || u < 0) least = lesser(least, squared_distance_to_segment(point, b, c));
  if (!are_sure || v < 0) least = lesser(least, squared_distance_to_segment(point, c, a));
  if (!are_sure || w < 0) least = lesser(least, squared_distance_to_segment(point, a, b));
  return least;
}

}  // namespace papilio
