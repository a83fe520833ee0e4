#pragma once

#include "papilio/options.h"
#include "proto/draco_writer.h"

namespace papilio::proto {

/// Upper bound of the memory that `write_draco` takes for a mesh refined from `coarse`, the stream included.
[[nodiscard]] OutputBytes encoding_bytes(const Mesh& coarse, const OutputOptions& options,
                                         const AttributeEncoding& encoding);

}  // namespace papilio::proto
