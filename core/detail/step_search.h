#pragma once

#include <algorithm>
#include <cmath>

namespace papilio {

// Models of distance and bytes as functions of the residuals' step, so that few steps are tried.

/// Returns the step expected to leave the distance `wanted`, given that `step` leaves `rms`. The squared error is
/// modelled as the squared floor, which exact residuals leave, plus a term proportional to the squared step. The floor
/// is clamped below `wanted`.
[[nodiscard]] inline double expected_step(double step, double rms, double floor, double wanted) {
  constexpr double largest_floor = 0.9;
  floor = std::min(floor, largest_floor * wanted);
  const double of_step = std::max(rms * rms - floor * floor, 0.01 * rms * rms);
  return step * std::clamp(0.99 * std::sqrt((wanted * wanted - floor * floor) / of_step), 0.3, 3.0);
}

/// Returns the expected bytes of the residuals at the distance `wanted`, as a share of those at `step`. They are about
/// proportional to a power of 1 / step; the saving by a larger distance is bounded by a power of it.
[[nodiscard]] inline double expected_share(double step, double rms, double floor, double wanted) {
  constexpr double bytes_by_step = 0.8, bytes_by_distance = 1.2;
  const double by_step = std::pow(step / expected_step(step, rms, floor, wanted), bytes_by_step);
  return std::max(by_step, std::pow(rms / wanted, bytes_by_distance));
}

}  // namespace papilio
