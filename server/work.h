#pragma once

#include <cstdint>

#include "papilio/options.h"
#include "proto/limits.h"

namespace papilio::server {

/// Predicted work of a request. The unit is a face of a uniform result: about 60 ns for refinement and encoding.
struct Work {
  uint64_t expected = 0;
  uint64_t most = 0;  ///< upper bound; equal to the expected work if the number of faces is known
};

/// Upper bound of small work: about a tenth of a second of one core.
inline constexpr uint64_t small_work = 1'500'000;

/// Predicts the work of refining a mesh of `coarse_faces`. Uniform levels have a known number of faces. With criteria,
/// the expected number is sixteen for one coarse face, as with a usual tolerance; the bound is the number of uniform
/// faces, `max_faces` or `max_output_faces`.
[[nodiscard]] Work predicted_work(uint64_t coarse_faces, const Options& options, const proto::Limits& limits);

}  // namespace papilio::server
