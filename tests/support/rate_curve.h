#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace papilio::test {

/// Size of one encoding of a model and its distances to the original, in percent of the diagonal.
struct RatePoint {
  double bytes = 0;
  double rms = 0;      ///< two-sided
  double largest = 0;  ///< two-sided
  size_t faces = 0;
  int bits = 0;  ///< per coordinate; 0: not applicable
};

/// Returns the points that no other point dominates, without those above the line between two others: bytes ascend, RMS
/// distances descend. Lines are straight in logarithms and join only points whose RMS distances differ by a factor of
/// at most 1.6: the full convex hull would be below concave curves, such as that of pure quantization.
[[nodiscard]] std::vector<RatePoint> lower_envelope(std::vector<RatePoint> points);

/// Returns bytes and largest distance at an RMS distance, interpolated linearly in logarithms between two points of the
/// envelope. Returns the smallest point if its RMS distance is lower, and nothing if all points have larger ones.
[[nodiscard]] std::optional<RatePoint> at_rms(const std::vector<RatePoint>& envelope, double rms);

}  // namespace papilio::test
