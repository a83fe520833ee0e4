#pragma once

#include <draco/core/encoder_buffer.h>

#include "proto/edgebreaker/positions.h"
#include "proto/edgebreaker/seams.h"
#include "proto/output_attribute.h"

// Attributes beside the positions. The order of their values is ours; predictions are libdraco's, as they are of many
// kinds and seldom cost much.

namespace papilio::proto::edgebreaker {

/// Writes what a decoder has to know of it first: what it is for, its type, components and id.
void describe(const OutputAttribute& attribute, draco::EncoderBuffer& out);

/// The surface that attributes are on, and how its walk and its positions were written.
struct WrittenSurface {
  const CornerMesh& mesh;
  const Array<uint32_t>& starts;      ///< [faces] (connectivity.h)
  const VertexOrder& order;           ///< of values without seams
  const Array<GridPoint>& positions;  ///< [vertices], where they are on a grid
  uint32_t points;                    ///< of the mesh: few are predicted otherwise than many
};

/// Writes the attribute's values: as differences from what is predicted at Draco's `speed`, 0 to 10, or as they are.
void write_values(const OutputAttribute& attribute, const Seams& seams, const WrittenSurface& written, int speed,
                  Pace& pace, draco::EncoderBuffer& out);

/// Writes what a decoder needs to come back from integers.
void write_coding(const OutputAttribute& attribute, draco::EncoderBuffer& out);

}  // namespace papilio::proto::edgebreaker
