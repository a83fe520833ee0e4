#pragma once

#include <string_view>

#include "proto/limits.h"
#include "proto/mesh_format.h"

namespace papilio::proto {

/// Decodes a Draco triangle mesh: its positions, faces and attributes. Whatever the bytes are, the answer is a mesh
/// whose indices are in range, or a `Problem`: mesh_not_draco (damaged, cut short), mesh_unsupported (version, point
/// cloud, positions that are not three floats), mesh_too_large (more than 16 attributes or 32 components of them too),
/// mesh_unusable (no faces, index out of range). Coordinates and values may still be NaN or infinite. Integers of 64
/// bits keep 53 of them.
[[nodiscard]] FormattedMesh read_draco(std::string_view bytes, const Limits& limits);

}  // namespace papilio::proto
