#pragma once

#include <functional>
#include <span>
#include <string>

#include "proto/output_attribute.h"

// Writes a Draco 2.2 edgebreaker stream straight from half-edges and positions. libdraco first builds the connectivity
// that the core has already, in time quadratic in the valence. The bytes are libdraco's, except where a mesh is not
// manifold or an attribute's integers are too large for its entropy coder (output_attribute.h). Work is near-linear in
// the faces, whatever their valences.

namespace papilio::proto::edgebreaker {

/// Writes the mesh with its positions on a grid. `poll`, if any, is called every few milliseconds; it may throw to
/// stop.
[[nodiscard]] std::string write(const Mesh& mesh, const QuantizationBox& box, const OutputOptions& options,
                                uint32_t position_id, std::span<const OutputAttribute> attributes = {},
                                const std::function<void()>& poll = {});

/// Writes the mesh with its positions to the bit, at speed 5. No attribute may need positions to be predicted
/// (`exact_attribute`).
[[nodiscard]] std::string write_exact(const Mesh& mesh, uint32_t position_id,
                                      std::span<const OutputAttribute> attributes);

}  // namespace papilio::proto::edgebreaker
