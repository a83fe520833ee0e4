#pragma once

#include "papilio/mesh.h"

namespace papilio {

/// Returns the mesh with its faces in the order of a Morton curve through their centres [Morton 1966], so that what is
/// near on the surface is near in memory. Points keep their numbers. O(F log F).
/// Not meshoptimizer's order, which may differ between its versions: packed files would, too.
[[nodiscard]] TriangleMesh along_morton_curve(TriangleMesh mesh);

}  // namespace papilio
