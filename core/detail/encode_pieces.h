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
  float step = 0;                            ///< 0: all residuals are 0
  std::vector<std::vector<uint8_t>> pieces;  ///< then none
};
/// Codes those of all levels in so many pieces each. Nothing where there are none.
using ValueCoder = std::function<std::vector<CodedValues>(std::span<const uint32_t> piece_counts)>;

/// Codes the levels of a fit, each in pieces of about so many bytes.
[[nodiscard]] std::vector<DetailStream> encode_pieces(const ResidualFit& fit, const PieceOrder& order,
                                                      uint64_t piece_bytes, const ValueCoder& code_values);

}  // namespace papilio
