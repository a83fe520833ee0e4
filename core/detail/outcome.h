#pragma once

#include <cstdint>

namespace papilio {

/// Distance and size of a base with its levels.
struct Outcome {
  double rms = 0;  ///< RMS distance
  uint64_t bytes = 0;
  bool is_reached = false;    ///< whether the distance is within the target
  double expected_bytes = 0;  ///< estimate at the target distance; infinite if no step reaches it
};

/// Returns whether candidate a is better than b.
[[nodiscard]] inline bool is_better(const Outcome& a, const Outcome& b) {
  return a.expected_bytes != b.expected_bytes ? a.expected_bytes < b.expected_bytes : a.rms < b.rms;
}
/// Returns whether result a is better than b: first by reaching the target.
[[nodiscard]] inline bool is_better_result(const Outcome& a, const Outcome& b) {
  if (a.is_reached != b.is_reached) return a.is_reached;
  return a.is_reached ? a.bytes < b.bytes : a.rms < b.rms;
}

}  // namespace papilio
