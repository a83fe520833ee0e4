#pragma once

#include <cstdint>

#include "papilio/mesh.h"

namespace papilio {

/// Flips the longest edges of slivers, faces whose height over it is within rounding of 0: where a straight line of
/// vertices was collapsed along itself, the face beyond is cut in two at the vertex between. Touches only faces from
/// number `first` on, and neither curves nor seams; no edge becomes non-manifold. Slivers that cannot be mended stay.
void flip_slivers(Mesh& mesh, uint32_t first);

}  // namespace papilio
