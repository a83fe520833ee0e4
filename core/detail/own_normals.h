#pragma once

#include <vector>

#include "papilio/detail.h"
#include "papilio/mesh.h"

namespace papilio {

/// Normals of an original, by the edges at which they are split.
struct OwnNormals {
  NormalStyle style = NormalStyle::absent;
  std::vector<bool> is_hard{};  ///< [E] whether they are split there; empty unless `style` is `creased`
};

/// Finds where the normals of a mesh, its attribute of three components and unit length, are split. The mesh must have
/// its edges. Normals whose directions alone are right are enough. O(E).
[[nodiscard]] OwnNormals find_own_normals(const Mesh& mesh);

/// Returns attributes without normals.
[[nodiscard]] std::vector<Attribute> without_normals(const std::vector<Attribute>& attributes);
}  // namespace papilio
