#include "mesh/grid_step.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <numeric>

namespace papilio {
namespace {

constexpr uint32_t least_grid_bits = 8, most_grid_bits = 16;
constexpr double padding = 1.25;        ///< of Papilio's grid
constexpr size_t least_values = 24;     ///< different numbers of steps
constexpr double roundings = 4;         ///< of the largest coordinate, in a decoder's arithmetic
constexpr double most_rounding = 0.05;  ///< share of a step; more would take any position for one on the grid

/// Returns whether all positions are on the grid with this many steps along the longest side, and on none with fewer.
bool is_on_grid(std::span<const Vec3f> positions, Vec3d origin, double longest, uint32_t steps, double rounding) {
  std::bitset<1U << most_grid_bits> used;
  uint32_t divisor = steps;
  for (const Vec3f& position : positions) {
    const Vec3d place = steps / longest * (to_double(position) - origin);
    for (const double at : {place.x, place.y, place.z}) {
      const double number = std::round(at);
      if (!(std::abs(at - number) <= rounding)) return false;
      const auto i = static_cast<uint32_t>(number);
      used.set(std::min(i, steps));
      divisor = std::gcd(divisor, i);
    }
  }
  return divisor == 1 && used.count() >= least_values;
}

}  // namespace

double grid_step(std::span<const Vec3f> positions) {
  const Box box = bounding_box(positions);
  const Vec3d origin = to_double(box.min);
  const Vec3d size = to_double(box.max) - origin;
  const double longest = std::max({size.x, size.y, size.z});
  if (!(longest > 0)) return 0;
  const double rounding_of_side = roundings * 0x1p-24 * std::max<double>(box.largest_coordinate(), longest) / longest;
  for (uint32_t bits = least_grid_bits; bits <= most_grid_bits; ++bits) {
    const uint32_t whole = (1U << bits) - 1;
    const auto padded = static_cast<uint32_t>(whole / padding);
    for (const uint32_t steps : {padded - 1, padded, padded + 1, whole}) {
      const double rounding = rounding_of_side * steps;
      if (rounding <= most_rounding && is_on_grid(positions, origin, longest, steps, rounding)) return longest / steps;
    }
  }
  return 0;
}

}  // namespace papilio
