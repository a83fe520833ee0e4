#pragma once

#include <string>

#include "papilio/options.h"
#include "proto/refinement.h"

namespace papilio::proto {

/// Describes each target (`tolerance`, `view.error_pixels`) that the refinement did not reach: target, remaining error
/// and advice. Returns "" if all are reached.
[[nodiscard]] std::string unreached_text(const Options& options, const Statistics& statistics);

}  // namespace papilio::proto
