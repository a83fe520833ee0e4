#pragma once

#include <optional>
#include <span>
#include <string>

#include "proto/output_attribute.h"

// Writes a Draco 2.2 stream straight from half-edges and positions, to the byte as libdraco writes it: that first
// builds the connectivity which the core has already.

namespace papilio::proto::edgebreaker {

/// Nothing, before a byte is written, where libdraco has to do it: speeds below 2; attributes with names, of 64 bits,
/// too large or with a range that is no float's; and meshes whose connectivity Draco sees otherwise (edges of three
/// faces or more, pairs of faces with two edges in common, vertices with several fans).
[[nodiscard]] std::optional<std::string> write(const Mesh& mesh, const QuantizationBox& box,
                                               const OutputOptions& options, uint32_t position_id,
                                               std::span<const OutputAttribute> attributes = {});

}  // namespace papilio::proto::edgebreaker
