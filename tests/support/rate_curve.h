#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace papilio::test {

/// What one encoding of a model costs and how far it is from the original; distances in percent of the diagonal.
struct RatePoint {
  double bytes = 0;
  double rms = 0;      ///< two-sided
  double largest = 0;  ///< two-sided
  size_t faces = 0;
  int bits = 0;  ///< of a coordinate; 0: not applicable
};

/// Points to which no other is nearer for at most as many bytes, without those above the line between two others: bytes
/// ascend, RMS distances descend. Lines are straight in logarithms and join only points whose RMS distances are at most
/// 1.6 times apart: the whole hull would undercut curves that are concave, as that of quantization alone is.
[[nodiscard]] std::vector<RatePoint> lower_envelope(std::vector<RatePoint> points);

/// Bytes and largest distance at an RMS distance: between two points of the envelope both are interpolated linearly
/// over the RMS distance, all three as logarithms. The smallest point where that is nearer; nothing where all points
/// are further.
[[nodiscard]] std::optional<RatePoint> at_rms(const std::vector<RatePoint>& envelope, double rms);

}  // namespace papilio::test
