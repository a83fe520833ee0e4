#pragma once

#include <draco/core/encoder_buffer.h>

#include <cstdint>
#include <span>

#include "papilio/buffer.h"

namespace papilio::proto::edgebreaker {

/// Compression level of libdraco if none is given.
inline constexpr int default_compression_level = 7;

/// Writes symbols entropy coded, with the bytes of draco::EncodeSymbols. The raw coding is rANS over a table of
/// probabilities. The tagged coding is rANS of the bit length of each value, followed by the bits. The shorter is
/// taken. `components`: symbols of a value, at least 1. `compression_level`: 0 to 10. Writes nothing for no symbols.
/// libdraco makes the tables, and codes symbols of more than 18 bits. Throws std::runtime_error if libdraco refuses the
/// symbols.
void write_symbols(std::span<const uint32_t> symbols, uint32_t components, int compression_level,
                   draco::EncoderBuffer& out);

/// Writes each list after its length, at the default level. The bytes are those of draco::EncodeSymbols for each list;
/// lists are coded in pairs, which is faster.
void write_symbol_lists(std::span<const Buffer<uint32_t>> lists, draco::EncoderBuffer& out);

}  // namespace papilio::proto::edgebreaker
