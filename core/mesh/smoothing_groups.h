#pragma once

#include "papilio/mesh.h"

namespace papilio {

/// Makes creases of the edges between two faces of different smoothing groups, and at faces of group 0, which are
/// smooth towards none. The groups are those of the first attribute with one component that
/// `Attribute::is_smoothing_group` names. A component whose faces all have one group says nothing about its edges: many
/// programs write one group, or none, for everything. Returns how many edges are marked, creases before or not. The
/// mesh must have its edges. O(F).
uint32_t mark_group_creases(Mesh& mesh);

}  // namespace papilio
