#pragma once

#include "criteria/selection.h"
#include "hierarchy/progress.h"
#include "papilio/refine.h"

namespace papilio {

/// Refines by the paper's scheme: each level splits edges of the level before, transition faces included.
[[nodiscard]] Result refine_in_place(Mesh coarse, const Options& options, const Selection& selection,
                                     const Progress& progress);

}  // namespace papilio
