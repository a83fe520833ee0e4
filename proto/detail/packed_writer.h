#pragma once

#include <string>
#include <vector>

#include "papilio/detail.h"
#include "proto/gltf/materials.h"

namespace papilio::proto::detail {

/// Writes a packed model (proto/detail.md). `base_streams`: Draco streams, one for each part, that together decode to
/// `detail.base`. `materials`: with their images, the material of the only part, or the materials numbered by the parts
/// (mesh_parts.h); or none. Distances are rounded up to 32-bit floats; all other values are stored exactly. Throws
/// `Problem` result_too_large beyond 4 GiB, and `std::invalid_argument` for a step or distance that readers refuse.
[[nodiscard]] std::string write_packed(const EncodedDetail& detail, const std::vector<std::string>& base_streams,
                                       const gltf::Materials& materials = {});

/// Writes a .glb scene of one mesh without levels. `streams`: Draco streams, one for each part, that together decode to
/// `decoded`, which may have normals. `normals`: style of the normals that readers derive. `materials` as of
/// write_packed().
[[nodiscard]] std::string write_plain(const TriangleMesh& decoded, const std::vector<std::string>& streams,
                                      NormalStyle normals = {}, const gltf::Materials& materials = {});

}  // namespace papilio::proto::detail
