#pragma once

#include <vector>

#include "base/poller.h"
#include "detail/original_surface.h"
#include "papilio/mesh.h"

namespace papilio {

/// Multiplies the weights [V] (empty: 1) of vertices where a surface is farther from the original than on average, and
/// of their neighbourhoods. A simplification with these weights keeps more there.
void weigh_errors(const OriginalSurface& original, TriangleMesh surface, std::vector<float>& weights,
                  const Poller& poller = {});

}  // namespace papilio
