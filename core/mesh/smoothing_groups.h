#pragma once

#include "papilio/mesh.h"

namespace papilio {

/// Makes creases of the edges between two faces of different smoothing groups, and of all edges at faces of group 0.
/// The groups are the first attribute with `Attribute::is_smoothing_group` and one component. A component with one
/// group is skipped: many programs write one group, or none, for all faces. Returns the number of marked edges,
/// including those that already were creases. The mesh must have edges. O(F).
uint32_t mark_group_creases(Mesh& mesh);

}  // namespace papilio
