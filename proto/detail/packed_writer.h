#pragma once

#include <string>
#include <string_view>

#include "papilio/detail.h"
#include "proto/gltf/materials.h"

namespace papilio::proto::detail {

/// Writes a packed model (proto/detail.md). `base_stream`: Draco stream that decodes to `detail.base`. `material`: that
/// of all faces, with its images; or none. Distances are
/// rounded up to 32-bit floats; all else is read back to the bit. Throws `Problem` result_too_large beyond 4 GiB, and
/// `std::invalid_argument` for a step or a distance that no reader takes.
[[nodiscard]] std::string write_packed(const EncodedDetail& detail, std::string_view base_stream,
                                       const gltf::Materials& material = {});

/// Writes a .glb scene of one mesh without levels. `stream`: Draco stream that decodes to `decoded`, which may have
/// normals. `normals`: style of those that readers are to find. `material` as above.
[[nodiscard]] std::string write_plain(const TriangleMesh& decoded, std::string_view stream, NormalStyle normals = {},
                                      const gltf::Materials& material = {});

}  // namespace papilio::proto::detail
