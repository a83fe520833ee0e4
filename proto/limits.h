#pragma once

#include <cstdint>

namespace papilio::proto {

/// Limits of one request, with the HTTP status beyond each. Each is checked before the work that it bounds.
struct Limits {
  uint64_t max_input_faces = 2'000'000;     ///< declared and decoded faces of a mesh: 413
  uint64_t max_input_vertices = 2'000'000;  ///< declared and decoded vertices (points) of a mesh: 413
  uint64_t max_output_faces = 8'000'000;    ///< faces of any level, predicted and actual: 507
  uint64_t max_compute_bytes = 0;           ///< memory of a level's arrays, predicted: 507; 0: no limit
  int max_compute_seconds = 0;              ///< decoding, refinement and encoding: 507; 0: no limit
};

}  // namespace papilio::proto
