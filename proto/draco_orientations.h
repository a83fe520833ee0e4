#pragma once

#include <draco/core/decoder_buffer.h>

#include <cstddef>

// A gap in Draco's decoder: where it predicts texture coordinates, it takes the number of orientations (one bit each,
// at most one for every value) on trust, and makes two billion of them from 255 bytes. For the reader only.

namespace papilio::proto {

/// Whether an attribute of `values` values, of `components` numbers each, may be predicted as the stream says. `buffer`
/// stands where Draco makes the prediction: behind the bytes that name it, before the corrections.
[[nodiscard]] bool has_sane_prediction(const draco::DecoderBuffer& buffer, size_t values, int components);

}  // namespace papilio::proto
