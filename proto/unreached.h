#pragma once

#include <string>

#include "papilio/options.h"
#include "proto/refinement.h"

namespace papilio::proto {

/// One sentence for each target (`tolerance`, `view.error_pixels`) that the refinement did not reach: the target, the
/// error left and what to do. Empty where all are reached.
[[nodiscard]] std::string unreached_text(const Options& options, const Statistics& statistics);

}  // namespace papilio::proto
