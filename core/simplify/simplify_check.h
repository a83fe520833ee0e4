#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "papilio/mesh.h"
#include "simplify/collapse.h"

namespace papilio {

/// Vertices, in the numbering before, at which the collapses did damage, in no order and with repeats: open half-edges
/// (boundaries, shared edges) or fans gained or lost, two faces folded onto each other, faces flipped or without a
/// normal, a component lost. Kinds of edges do not count, except that neither mesh may have creases. `poll` is called
/// between steps; it may throw to stop.
[[nodiscard]] std::vector<uint32_t> find_faults(const Mesh& before, const Collapsed& after,
                                                const std::function<void()>& poll);

}  // namespace papilio
