#include "proto/quantization_box.h"

#include <algorithm>
#include <cmath>

#include "proto/problem.h"

namespace papilio::proto {
namespace {

/// Returns the edge length of the cube for a box of this size.
double grid_range(Vec3d size) { return 1.25 * std::max({size.x, size.y, size.z}); }

}  // namespace

QuantizationBox quantization_box(const Buffer<Vec3f>& coarse) {
  const Box box = bounding_box(coarse);
  const Vec3d low = to_double(box.min);
  const Vec3d size = to_double(box.max) - low;
  const double range = grid_range(size);
  if (range < least_range) throw Problem(Code::mesh_unusable, "The extent of the mesh is below 1e-30. Scale it up.");
  const Vec3d centre = low + 0.5 * size;
  return {to_float(centre - 0.5 * Vec3d{range, range, range}), static_cast<float>(range)};
}

double grid_distance(const Box& coarse, int position_bits) {
  const double step = grid_range(to_double(coarse.max) - to_double(coarse.min)) / ((1 << position_bits) - 1);
  return 0.5 * std::sqrt(3.0) * step;
}

double tolerance_beside_grid(double tolerance, double grid_error) {
  constexpr double most_for_grid = 0.5;
  return std::max(tolerance - grid_error, most_for_grid * tolerance);
}

}  // namespace papilio::proto
