#pragma once

#include "criteria/selection.h"
#include "hierarchy/levels.h"
#include "hierarchy/progress.h"
#include "papilio/refine.h"

namespace papilio {

/// Refines by the red-green scheme: level by level down the hierarchy of the uniform subdivision (`levels`), then
/// closed in the result by transition faces. Every vertex is, to the bit, that of the uniform result, and neighbours
/// differ by one level at most.
///
/// Without a tolerance or budget a level asks which edges the criteria want, and a face goes on when all three are
/// wanted. With one, errors decide, and what lies deeper counts: an edge is also split when a face below needs it
/// (as its own half, or so that neighbours do not differ by more than a level). So faces are divided only where
/// something below still exceeds the tolerance, and elsewhere single edges are split. Moves below the tolerance add up
/// from level to level: at the end the result is compared with the surface, and split where it is further away
/// (hierarchy/repair.h).
[[nodiscard]] Result refine_red_green(Levels levels, const Options& options, const Selection& selection,
                                      const Progress& progress);

}  // namespace papilio
