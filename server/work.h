#pragma once

#include <cstdint>

#include "papilio/options.h"
#include "proto/limits.h"

namespace papilio::server {

/// Work of a request, predicted before it begins. The unit is a face of a uniform result, some 60 ns with its share of
/// refinement and encoding.
struct Work {
  uint64_t expected = 0;
  uint64_t most = 0;  ///< upper bound; the same where the number of faces is known
};

/// Work up to this is small: about a tenth of a second of one core.
inline constexpr uint64_t small_work = 1'500'000;

/// Predicts the work of refining a mesh of `coarse_faces`. Uniform levels have a known number of faces. Criteria choose
/// faces only later: a usual tolerance makes up to sixteen of one; the bound is the number of uniform faces,
/// `max_faces` or `max_output_faces`.
[[nodiscard]] Work predicted_work(uint64_t coarse_faces, const Options& options, const proto::Limits& limits);

}  // namespace papilio::server
