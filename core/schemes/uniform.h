#pragma once

#include "criteria/selection.h"
#include "hierarchy/progress.h"

namespace papilio {

/// Throws `Error` result_too_large, with the number, if a level would exceed a limit.
void require_room_for_uniform(const Mesh& coarse, const Options& options, const Progress& progress);

/// Splits every edge, level by level. `selection` only measures the error left.
[[nodiscard]] Result refine_uniformly(Mesh coarse, const Options& options, const Selection& selection,
                                      const Progress& progress);

}  // namespace papilio
