#pragma once

#include <algorithm>
#include <cmath>

namespace papilio {

// How distance and bytes go with the step of the residuals, so that few steps need be tried.

/// Step that should leave the wanted distance, where `step` leaves `rms`: the error's square is taken for the sum of
/// the floor's, which exact residuals leave, and of one in proportion to the step's. No step is taken to leave the
/// wanted distance where the floor is nearly as much.
[[nodiscard]] inline double expected_step(double step, double rms, double floor, double wanted) {
  constexpr double largest_floor = 0.9;
  floor = std::min(floor, largest_floor * wanted);
  const double of_step = std::max(rms * rms - floor * floor, 0.01 * rms * rms);
  return step * std::clamp(0.99 * std::sqrt((wanted * wanted - floor * floor) / of_step), 0.3, 3.0);
}

/// Bytes of the residuals at the wanted distance, as a share of those at `step`. They go about with a power of 1 /
/// step; a larger distance saves no more than a power of it.
[[nodiscard]] inline double expected_share(double step, double rms, double floor, double wanted) {
  constexpr double bytes_by_step = 0.8, bytes_by_distance = 1.2;
  const double by_step = std::pow(step / expected_step(step, rms, floor, wanted), bytes_by_step);
  return std::max(by_step, std::pow(rms / wanted, bytes_by_distance));
}

}  // namespace papilio
