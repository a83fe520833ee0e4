#pragma once

#include <string_view>

#include "core/triangle_mesh.h"
#include "proto/limits.h"

namespace papilio::proto {

/// Decodes a Draco triangle mesh: its positions and faces. Whatever the bytes are, the answer is a mesh whose
/// indices are in range, or a `Problem`: mesh_not_draco (damaged, cut short), mesh_unsupported (version,
/// point cloud, positions that are not three floats), mesh_too_large, mesh_unusable (no faces, index out of
/// range). Coordinates may still be NaN or infinite.
[[nodiscard]] TriangleMesh read_draco(std::string_view bytes, const Limits& limits);

}  // namespace papilio::proto
