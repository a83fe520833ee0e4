#pragma once

#include <cstdint>

namespace papilio {

/// What a base with its levels comes to.
struct Outcome {
  double rms = 0;  ///< distance
  uint64_t bytes = 0;
  bool is_reached = false;    ///< whether the distance is the wanted one
  double expected_bytes = 0;  ///< at the wanted distance; infinite where no step leaves it
};

/// Whether one trial is better than another.
[[nodiscard]] inline bool is_better(const Outcome& a, const Outcome& b) {
  return a.expected_bytes != b.expected_bytes ? a.expected_bytes < b.expected_bytes : a.rms < b.rms;
}
/// Whether one result is.
[[nodiscard]] inline bool is_better_result(const Outcome& a, const Outcome& b) {
  if (a.is_reached != b.is_reached) return a.is_reached;
  return a.is_reached ? a.bytes < b.bytes : a.rms < b.rms;
}

}  // namespace papilio
