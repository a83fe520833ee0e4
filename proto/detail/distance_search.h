#pragma once

#include <functional>
#include <span>
#include <vector>

namespace papilio::proto::detail {

/// Encoding at an RMS distance, and the number that is held against the goal.
struct Probe {
  double rms = 0;
  double value = 0;

  friend bool operator==(const Probe&, const Probe&) = default;
};

/// What is searched for: the RMS distance whose value comes nearest to the goal from below.
struct DistanceGoal {
  double value = 0;  ///< goal, above 0
  /// Exponent of the power of the distance that the value is expected to follow: above 0 where it grows with the
  /// distance, below where it falls.
  double power = 1;
  double first = 1e-4;              ///< first distance
  double least = 1e-6, most = 0.1;  ///< bounds of the distance
};

/// Most encodings of a search.
inline constexpr size_t most_probes = 7;

/// Encodes at some distances, independently of each other, and returns the values in their order. Values are above 0.
using MeasureRound = std::function<std::vector<double>(std::span<const double>)>;

/// Searches by brackets: in rounds of up to two distances, on the line through the logarithms of the nearest two
/// probes, until a value is within 1 % below the goal, or none but the bounds are left. The distances depend on the
/// values alone. Returns all probes in the order in which they were made.
[[nodiscard]] std::vector<Probe> search_distance(const DistanceGoal& goal, const MeasureRound& measure);

}  // namespace papilio::proto::detail
