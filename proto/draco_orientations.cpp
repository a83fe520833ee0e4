#include "proto/draco_orientations.h"

#include <draco/compression/config/compression_shared.h>
#include <draco/compression/entropy/symbol_decoding.h>

#include <cstdint>
#include <vector>

namespace papilio::proto {
namespace {

/// Skips the corrections of an attribute. Returns false for damaged corrections, which libdraco refuses.
bool skip_corrections(draco::DecoderBuffer& buffer, size_t count, int components) {
  uint8_t is_compressed = 0;
  if (!buffer.Decode(&is_compressed)) return false;
  if (is_compressed != 0) {
    std::vector<uint32_t> corrections(count);
    return draco::DecodeSymbols(static_cast<uint32_t>(count), components, &buffer, corrections.data());
  }
  uint8_t bytes = 0;
  if (!buffer.Decode(&bytes) || buffer.remaining_size() < static_cast<int64_t>(bytes * count)) return false;
  buffer.Advance(static_cast<int64_t>(bytes * count));
  return true;
}

}  // namespace

bool has_valid_prediction(const draco::DecoderBuffer& buffer, size_t values, int components) {
  const char method = buffer.data_head()[-2];                                // the last byte is the transform
  if (method == draco::MESH_PREDICTION_TEX_COORDS_DEPRECATED) return false;  // not part of bitstream 2.2
  if (method != draco::MESH_PREDICTION_TEX_COORDS_PORTABLE) return true;
  constexpr int texture_components = 2;
  if (components != texture_components) return false;
  draco::DecoderBuffer ahead = buffer;
  int32_t orientations = 0;
  if (!skip_corrections(ahead, values * texture_components, components) || !ahead.Decode(&orientations)) return true;
  return orientations >= 0 && static_cast<size_t>(orientations) <= values;
}

}  // namespace papilio::proto
