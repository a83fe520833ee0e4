#pragma once

#include "papilio/options.h"
#include "proto/draco_writer.h"

namespace papilio::proto {

/// Returns an upper bound of the memory of `write_draco` for a mesh refined from one with these attributes, whose
/// values do not matter, including the stream. `adds_normals`: to those that `format` describes.
[[nodiscard]] OutputBytes encoding_bytes(const std::vector<Attribute>& coarse, bool adds_normals,
                                         const MeshFormat& format);

}  // namespace papilio::proto
