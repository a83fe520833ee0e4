#pragma once

#include <functional>
#include <span>
#include <vector>

namespace papilio::proto::detail {

/// Encoding at an RMS distance, and its value, which is compared with the goal.
struct Probe {
  double rms = 0;
  double value = 0;

  friend bool operator==(const Probe&, const Probe&) = default;
};

/// Goal of a search: the RMS distance whose value is nearest to the goal from below.
struct DistanceGoal {
  double value = 0;  ///< goal, above 0
  /// Exponent of the power of the distance that the value is expected to follow: positive if it grows with the
  /// distance, negative if it falls.
  double power = 1;
  double first = 1e-4;              ///< first distance
  double least = 1e-6, most = 0.1;  ///< bounds of the distance
};

/// Upper bound of the encodings of a search.
inline constexpr size_t most_probes = 7;

/// Function that encodes at several distances, independently of each other, and returns their values, all above 0.
using MeasureRound = std::function<std::vector<double>(std::span<const double>)>;

/// Searches by brackets, in rounds of up to two distances, on the line through the logarithms of the nearest two
/// probes. Ends if a value is within 1 % below the goal, or if only the bounds are left. Distances depend on values
/// alone. Returns all probes in their order.
[[nodiscard]] std::vector<Probe> search_distance(const DistanceGoal& goal, const MeasureRound& measure);

}  // namespace papilio::proto::detail
