#pragma once

#include <vector>

#include "papilio/mesh.h"

namespace papilio::test {

/// Returns every connected oriented surface of this many triangles, with at most two at an edge, of any genus and
/// with any holes and pinched vertices. Surfaces that differ only by numbering are returned once; mirror images are
/// distinct. Positions are random.
[[nodiscard]] std::vector<TriangleMesh> small_surfaces(uint32_t triangles);

}  // namespace papilio::test
