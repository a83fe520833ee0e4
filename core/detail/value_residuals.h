#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "detail/detail_level.h"
#include "detail/pieces.h"
#include "detail/residual_models.h"
#include "papilio/buffer.h"

namespace papilio {

/// Residuals of the values of a level's new vertices, in steps: [components][E].
using ValueResiduals = std::vector<Buffer<int32_t>>;

/// Adaptive models of each component, kept from level to level.
using ValueModels = std::vector<ResidualModels>;

/// One component of the values.
struct ValueChannel {
  /// Values [V + E] of its attribute, predicted at the new vertices.
  const Buffer<Vec3f>* predicted = nullptr;
  float step = 0;
};

/// Encodes the residuals of a level of a surface cut along its seams, each piece independently. `at_vertex`
/// [components][V]: residuals of the vertices, 0 on the base.
[[nodiscard]] std::vector<std::vector<uint8_t>> encode_value_residuals(
    const DetailLevel& level, const EdgePieces& pieces, std::span<const ValueChannel> channels,
    const ValueResiduals& residuals, const ValueResiduals& at_vertex, ValueModels& models);
/// Decodes the bytes of encode_value_residuals(). Any other bytes are decoded to residuals within `largest_residual`.
[[nodiscard]] ValueResiduals decode_value_residuals(const DetailLevel& level, const EdgePieces& pieces,
                                                    std::span<const ValueChannel> channels, const PieceBytes& bytes,
                                                    const ValueResiduals& at_vertex, ValueModels& models);

}  // namespace papilio
