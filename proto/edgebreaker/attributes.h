#pragma once

#include <draco/core/encoder_buffer.h>

#include "proto/edgebreaker/positions.h"
#include "proto/edgebreaker/seams.h"
#include "proto/output_attribute.h"

// Attributes beside the positions. The order of their values is ours; predictions are libdraco's, as they are of many
// kinds and seldom cost much.

namespace papilio::proto::edgebreaker {

/// Whether the attribute can be written from here: predicted integers of 32 bits, whatever they stand for, without a
/// name.
[[nodiscard]] bool can_write(const OutputAttribute& attribute);

/// Writes what a decoder has to know of it first: what it is for, its type, components and id.
void describe(const OutputAttribute& attribute, draco::EncoderBuffer& out);
/// How its values are coded, in Draco's numbers.
[[nodiscard]] uint8_t coding_byte(const OutputAttribute& attribute);

/// The surface that attributes are on, and how its walk and its positions were written.
struct WrittenSurface {
  const CornerMesh& mesh;
  const Array<uint32_t>& starts;      ///< [faces] (connectivity.h)
  const VertexOrder& order;           ///< of the positions
  const Array<GridPoint>& positions;  ///< [vertices]
};

/// Writes the attribute's values, as differences from what is predicted at Draco's `speed`, 2 to 10. False where that
/// leads to numbers too large: libdraco says so.
[[nodiscard]] bool write_values(const OutputAttribute& attribute, const Seams& seams, const WrittenSurface& surface,
                                int speed, draco::EncoderBuffer& out);

/// Writes what a decoder needs to come back from integers.
void write_coding(const OutputAttribute& attribute, draco::EncoderBuffer& out);

}  // namespace papilio::proto::edgebreaker
