#pragma once

#include "mesh/blended_points.h"
#include "mesh/draft.h"

namespace papilio {

/// Closes gaps of at most `distance` in a connected draft: welds boundary vertices (weld_gaps.h), inserts those of
/// T-junctions (t_junctions.h) and welds again. Gaps stay open where closing them would make a defect. Without gaps,
/// the draft stays bit-identical. Counts changes in the report. O(H log H), bounded work.
void close_gaps(Draft& draft, BlendedPoints& points, double distance);

}  // namespace papilio
