#pragma once

#include <string_view>

#include "proto/limits.h"
#include "proto/mesh_format.h"

namespace papilio::proto {

/// Decodes positions, faces and attributes of a Draco triangle mesh. For any bytes, either returns a mesh with indices
/// in range or throws `Problem`: mesh_not_draco (damaged, truncated), mesh_unsupported (version, point cloud, positions
/// that are not three floats), mesh_too_large (`limits`, more than 16 attributes or 32 components), mesh_unusable (no
/// faces, index out of range). Values may be NaN or infinite. Integers of 64 bits are rounded to 53 bits.
[[nodiscard]] FormattedMesh read_draco(std::string_view bytes, const Limits& limits);

}  // namespace papilio::proto
