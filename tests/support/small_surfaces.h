#pragma once

#include <vector>

#include "papilio/mesh.h"

namespace papilio::test {

/// Every way to put so many triangles together, each at an edge of one before, wound alike, no more than two at an
/// edge: each connected surface once, whatever its genus and its holes, and those that touch themselves at vertices.
/// Two that differ only by their numbers are one; mirror images are two. Positions are random.
[[nodiscard]] std::vector<TriangleMesh> small_surfaces(uint32_t triangles);

}  // namespace papilio::test
