#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "papilio/mesh.h"
#include "simplify/collapse.h"

namespace papilio {

/// Returns the vertices, by their numbers before, at which the collapses made a fault; unordered and with repeats.
/// Faults are open half-edges (boundaries, shared edges) or fans gained or lost, faces folded, flipped or without a
/// normal, and lost components. Kinds of edges are not compared, but neither mesh may have creases. `poll` is called
/// between steps; it may throw to stop.
[[nodiscard]] std::vector<uint32_t> find_faults(const Mesh& before, const Collapsed& after,
                                                const std::function<void()>& poll);

}  // namespace papilio
