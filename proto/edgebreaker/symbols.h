#pragma once

#include <draco/core/encoder_buffer.h>

#include <cstdint>
#include <span>

#include "papilio/buffer.h"

namespace papilio::proto::edgebreaker {

/// Draco's level where a writer asks for none.
inline constexpr int default_compression_level = 7;

/// Writes symbols entropy coded, to the byte as draco::EncodeSymbols does: asymmetric numeral systems over a table of
/// probabilities, or, where that is shorter, the bits of each value after how many they are. `components` of them make
/// a value, at least 1; `compression_level` 0 to 10. Tables are libdraco's, and so is all where a symbol has more than
/// 18 bits. Nothing is written for no symbols. Throws std::runtime_error where Draco refuses.
void write_symbols(std::span<const uint32_t> symbols, uint32_t components, int compression_level,
                   draco::EncoderBuffer& out);

/// Writes each list of symbols, behind how many they are, at the default level: what draco::EncodeSymbols makes of one
/// after the other, sooner.
void write_symbol_lists(std::span<const Buffer<uint32_t>> lists, draco::EncoderBuffer& out);

}  // namespace papilio::proto::edgebreaker
