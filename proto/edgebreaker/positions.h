#pragma once

#include <draco/core/encoder_buffer.h>

#include "proto/draco_writer.h"
#include "proto/edgebreaker/vertex_order.h"

namespace papilio::proto::edgebreaker {

/// How a position is predicted from those before it.
enum class Prediction : int8_t {
  difference = 0,  ///< as the last one
  parallelogram =
      1,  ///< the fourth corner of the parallelogram over the face beyond; where it is not known, the last one
};

/// A point of the grid, and what is computed with it; the fourth lane is never looked at. Compilers have such types for
/// every machine.
using GridPoint = int32_t __attribute__((vector_size(16)));

/// Positions on the grid of 2^bits steps along the box.
[[nodiscard]] Array<GridPoint> to_grid(const Array<Vec3f>& positions, const QuantizationBox& box, int bits);

/// Writes the positions [vertices] in the order of their vertices, as differences from what is predicted.
/// `compression_level` of Draco's entropy coder, 0 to 10.
void write_positions(const CornerMesh& mesh, const VertexOrder& order, const Array<GridPoint>& values,
                     Prediction prediction, int compression_level, draco::EncoderBuffer& out);

/// Writes what a decoder needs to come back from the grid.
void write_grid(const QuantizationBox& box, int bits, draco::EncoderBuffer& out);

}  // namespace papilio::proto::edgebreaker
