#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "detail/pieces.h"
#include "detail/residual_fit.h"
#include "papilio/detail.h"

namespace papilio {

/// Texture coordinates and colours of one level, coded.
struct CodedValues {
  float step = 0;                            ///< quantization step; 0: all residuals are 0
  std::vector<std::vector<uint8_t>> pieces;  ///< bytes of each piece; empty if all residuals are 0
};
/// Function that codes the values of all levels in `piece_counts` [level] pieces. Returns nothing without values.
using ValueCoder = std::function<std::vector<CodedValues>(std::span<const uint32_t> piece_counts)>;

/// Codes the levels of a fit, each in pieces of about `piece_bytes` bytes.
[[nodiscard]] std::vector<DetailStream> encode_pieces(const ResidualFit& fit, const PieceOrder& order,
                                                      uint64_t piece_bytes, const ValueCoder& code_values);

}  // namespace papilio
