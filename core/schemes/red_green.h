#pragma once

#include "criteria/selection.h"
#include "hierarchy/levels.h"
#include "hierarchy/progress.h"
#include "papilio/refine.h"

namespace papilio {

/// Refines by the red-green scheme: level by level down the hierarchy of the uniform subdivision (`levels`). Transition
/// faces close the result. Every vertex is bit-identical to a vertex of the uniform result, and neighbours differ by at
/// most one level.
///
/// Without tolerance or budget, criteria select edges level by level, and a face is divided if all three are selected.
/// With either, errors decide, including those of deeper levels: an edge is also split if a face below requires it, for
/// its halves or to keep neighbours within one level. So faces are divided only above errors that exceed the tolerance;
/// elsewhere single edges are split. Moves below the tolerance add up over levels: finally the result is compared with
/// the surface, and split where it is too far away (hierarchy/repair.h).
[[nodiscard]] Result refine_red_green(Levels levels, const Options& options, const Selection& selection,
                                      const Progress& progress);

}  // namespace papilio
