#pragma once

#include "papilio/options.h"
#include "proto/draco_writer.h"

namespace papilio::proto {

/// Returns an upper bound of the memory of `write_draco` for a mesh refined from `coarse`, including the stream.
[[nodiscard]] OutputBytes encoding_bytes(const Mesh& coarse, const OutputOptions& options,
                                         const AttributeEncoding& encoding);

}  // namespace papilio::proto
