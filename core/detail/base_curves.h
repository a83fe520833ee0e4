#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// Codes which edges of a base are creases, and at which of its vertices with two curve edges curves end. The base must
/// be manifold. No bytes where it has neither.
[[nodiscard]] std::vector<uint8_t> encode_base_curves(const Topology& base);

/// Marks the creases, darts and corners that encode_base_curves() coded. Any bytes give some curves.
void decode_base_curves(std::span<const uint8_t> bytes, Topology& base);

}  // namespace papilio
