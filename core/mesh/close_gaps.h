#pragma once

#include "mesh/blended_points.h"
#include "mesh/draft.h"

namespace papilio {

/// Closes the gaps of a connected draft that are no wider than `distance`: welds boundary vertices (weld_gaps.h), then
/// inserts those of T-junctions (t_junctions.h) and welds again. Keeps the draft as it is, to the bit, where there is
/// nothing to close; leaves open what would make a defect. Counts what it does. O(H log H), bounded work.
void close_gaps(Draft& draft, BlendedPoints& points, double distance);

}  // namespace papilio
