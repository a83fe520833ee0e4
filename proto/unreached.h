#pragma once

#include <string>

#include "papilio/options.h"
#include "proto/refinement.h"

namespace papilio::proto {

/// Share of a grid of encoded positions in the error.
struct GridShare {
  double error = 0;  ///< distance by which it moves positions, a share of the diagonal; part of Statistics::error
  int bits = 0;      ///< `output.position_bits`
};

/// Describes each target (`tolerance`, `view.error_pixels`) that the refinement did not reach: target, remaining error,
/// its reason and advice. Returns "" if all are reached.
[[nodiscard]] std::string unreached_text(const Options& options, const Statistics& statistics,
                                         const GridShare& grid = {});

}  // namespace papilio::proto
