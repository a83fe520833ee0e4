#pragma once

#include <cstdint>

#include "papilio/mesh.h"

namespace papilio {

/// Flips the longest edges of slivers: faces whose height over that edge is within rounding of 0. They arise where a
/// straight line of vertices is collapsed along itself. Changes only faces from number `first` on, and neither curves
/// nor seams; no edge becomes non-manifold. Keeps slivers that cannot be flipped.
void flip_slivers(Mesh& mesh, uint32_t first);

}  // namespace papilio
