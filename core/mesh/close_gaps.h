#pragma once

#include "mesh/draft.h"

namespace papilio {

/// Closes the gaps of a connected draft that are no wider than `distance`: welds boundary vertices (weld_gaps.h). Keeps
/// the draft as it is, to the bit, where there is nothing to close or a defect would arise. Counts what it does.
void close_gaps(Draft& draft, double distance);

}  // namespace papilio
