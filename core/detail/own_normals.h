#pragma once

#include <vector>

#include "papilio/detail.h"
#include "papilio/mesh.h"

namespace papilio {

/// Normals of an original, by the edges at which they are split.
struct OwnNormals {
  NormalStyle style = NormalStyle::absent;
  std::vector<bool> is_hard{};  ///< [E] whether normals are split at the edge; empty unless `style` is `creased`
};

/// Finds the edges at which the normals of a mesh, its attribute of 3 components and unit length, are split. Only the
/// directions of normals matter. The mesh must have edges. O(E).
[[nodiscard]] OwnNormals find_own_normals(const Mesh& mesh);

/// Returns attributes without normals.
[[nodiscard]] std::vector<Attribute> without_normals(const std::vector<Attribute>& attributes);
}  // namespace papilio
