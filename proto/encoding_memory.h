#pragma once

#include "papilio/options.h"
#include "proto/draco_writer.h"

namespace papilio::proto {

/// Returns an upper bound of the memory of `write_draco` for a mesh refined from `coarse`, including the stream.
/// `adds_normals`: to those that `encoding` describes.
[[nodiscard]] OutputBytes encoding_bytes(const Mesh& coarse, bool adds_normals, const AttributeEncoding& encoding);

}  // namespace papilio::proto
