#pragma once

#include <string>
#include <vector>

#include "papilio/detail.h"
#include "proto/gltf/materials.h"

namespace papilio::proto::detail {

/// Writes a packed model (proto/detail.md). `base_streams`: Draco streams, one for each part, that together decode to
/// `detail.base`. `materials` with their images: that of all faces where there is one part, else those that the parts
/// name (mesh_parts.h); or none. Distances are rounded up to 32-bit floats; all else is read back to the bit. Throws
/// `Problem` result_too_large beyond 4 GiB, and `std::invalid_argument` for a step or a distance that no reader takes.
[[nodiscard]] std::string write_packed(const EncodedDetail& detail, const std::vector<std::string>& base_streams,
                                       const gltf::Materials& materials = {});

/// Writes a .glb scene of one mesh without levels. `streams`: Draco streams as above that decode to `decoded`, which
/// may have normals. `normals`: style of those that readers are to find. `materials` as above.
[[nodiscard]] std::string write_plain(const TriangleMesh& decoded, const std::vector<std::string>& streams,
                                      NormalStyle normals = {}, const gltf::Materials& materials = {});

}  // namespace papilio::proto::detail
