#pragma once

#include "papilio/mesh.h"

namespace papilio {

/// Makes creases of the edges between two faces of different smoothing groups. Group 0, or `off`, is one of them: an
/// edge within it would be sharp by the letter, but most programs write it for round parts that no one set to be
/// smooth. The groups are the first attribute with `Attribute::is_smoothing_group` and one component. Returns the
/// number of marked edges, including those that already were creases. The mesh must have edges. O(F).
uint32_t mark_group_creases(Mesh& mesh);

}  // namespace papilio
