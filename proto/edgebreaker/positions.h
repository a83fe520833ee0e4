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

/// Writes the positions [vertices] on the grid of 2^bits steps along the box, in the order of their vertices, as
/// differences from what is predicted. `compression_level` of Draco's entropy coder, 0 to 10.
void write_positions(const CornerMesh& mesh, const VertexOrder& order, const Array<Vec3f>& positions,
                     const QuantizationBox& box, int bits, Prediction prediction, int compression_level,
                     draco::EncoderBuffer& out);

}  // namespace papilio::proto::edgebreaker
