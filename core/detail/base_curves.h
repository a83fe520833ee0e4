#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// Codes the creases of a base, and its corners: vertices with two curve edges at which curves end. Returns no bytes if
/// there are neither. The base must be manifold.
[[nodiscard]] std::vector<uint8_t> encode_base_curves(const Topology& base);

/// Marks the creases, darts and corners coded by encode_base_curves(). Any bytes are decoded to some curves.
void decode_base_curves(std::span<const uint8_t> bytes, Topology& base);

}  // namespace papilio
