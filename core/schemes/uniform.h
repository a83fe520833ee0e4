#pragma once

#include "criteria/selection.h"
#include "hierarchy/progress.h"

namespace papilio {

/// Throws `Error` result_too_large, with the number, where a level would pass a limit.
void require_room_for_uniform(const Mesh& coarse, const Options& options, const Progress& progress);

/// Splits every edge, level by level. No criterion is looked at; `selection` measures the error that is left.
[[nodiscard]] Result refine_uniformly(Mesh coarse, const Options& options, const Selection& selection,
                                      const Progress& progress);

}  // namespace papilio
