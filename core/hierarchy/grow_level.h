#pragma once

#include <vector>

#include "hierarchy/hierarchy.h"

namespace papilio {

/// Tries the complete edges of a level that holds all that `known`, a level of the same depth, holds, and more. What is
/// known is taken from there: only the rest is computed. `moved` [F of known]: the same faces in `level`.
void try_grown_level(HierarchyLevel& level, const Options& options, const HierarchyLevel& known,
                     const Buffer<uint32_t>& moved);

}  // namespace papilio
