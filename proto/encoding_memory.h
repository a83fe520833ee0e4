#pragma once

#include "papilio/options.h"
#include "proto/draco_writer.h"

namespace papilio::proto {

/// Returns an upper bound of the memory of write_draco(), including the stream, for a refinement of a mesh with these
/// attributes; their values have no effect. `adds_normals`: whether normals are added to the attributes of `format`.
[[nodiscard]] OutputBytes encoding_bytes(const std::vector<Attribute>& coarse, bool adds_normals,
                                         const MeshFormat& format);

}  // namespace papilio::proto
