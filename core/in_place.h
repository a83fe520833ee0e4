#pragma once

#include "mesh.h"
#include "split_plan.h"

namespace papilio {

/// One level of the paper's scheme: splits the target edges of `mesh` and its faces by their patterns, and
/// makes the result the mesh that the next level works on, transition patterns included. Old vertices keep
/// their numbers and their positions to the bit; `w` as in `butterfly`.
[[nodiscard]] Mesh refine_in_place(Mesh mesh, const SplitPlan& plan, float w);

}  // namespace papilio
