#pragma once

#include "progress.h"
#include "selection.h"

namespace papilio {

/// Splits every edge, level by level. No criterion is looked at; `selection` measures the error that is left.
[[nodiscard]] Result refine_uniformly(Mesh coarse, const Options& options, const Selection& selection,
                                      const Progress& progress);

}  // namespace papilio
