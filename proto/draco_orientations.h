#pragma once

#include <draco/core/decoder_buffer.h>

#include <cstddef>

// Guard against a weakness of libdraco's decoder: it trusts the number of orientations in a prediction of texture
// coordinates. A stream of 255 bytes can declare two billion. For the reader only.

namespace papilio::proto {

/// Returns whether the stream has a valid prediction for an attribute of `values` values of `components` numbers.
/// `buffer`: at the corrections, after the bytes of prediction method and transform.
[[nodiscard]] bool has_valid_prediction(const draco::DecoderBuffer& buffer, size_t values, int components);

}  // namespace papilio::proto
