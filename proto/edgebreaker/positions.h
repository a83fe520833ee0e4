#pragma once

#include <draco/core/encoder_buffer.h>

#include "proto/draco_writer.h"
#include "proto/edgebreaker/surface.h"
#include "proto/edgebreaker/vertex_order.h"

namespace papilio::proto::edgebreaker {

/// How a position is predicted from those before it.
enum class Prediction : int8_t {
  difference = 0,  ///< as the last one
  parallelogram =
      1,  ///< the fourth corner of the parallelogram over the face beyond; where it is not known, the last one
};

/// A point of the grid, and what is computed with it; the fourth lane is 0. Compilers have such types for every
/// machine.
using GridPoint = int32_t __attribute__((vector_size(16)));

/// The positions of the surface's vertices on the grid of 2^bits steps along the box.
[[nodiscard]] Buffer<GridPoint> to_grid(const Buffer<Vec3f>& positions, const Surface& surface,
                                        const QuantizationBox& box, int bits);

/// Writes the positions [vertices] in the order of their vertices, as differences from what is predicted.
/// `compression_level` of Draco's entropy coder, 0 to 10. `pace` steps once a value.
void write_positions(const CornerMesh& mesh, const VertexOrder& order, const Buffer<GridPoint>& values,
                     Prediction prediction, int compression_level, Pace& pace, draco::EncoderBuffer& out);

/// Writes the positions in the order of these corners, predicted from the best mean of up to four parallelograms, or
/// from one where the mesh has few `points`: what Draco does at `speed` 0 and 1.
void write_positions_multi_parallelogram(const CornerMesh& mesh, const Buffer<uint32_t>& corners,
                                         const Buffer<GridPoint>& values, int speed, uint32_t points, Pace& pace,
                                         draco::EncoderBuffer& out);

/// Writes the mesh's positions as floats in the order of these corners.
void write_positions_exactly(const Buffer<Vec3f>& positions, const Surface& surface, const Buffer<uint32_t>& corners,
                             Pace& pace, draco::EncoderBuffer& out);

/// Writes what a decoder needs to come back from the grid.
void write_grid(const QuantizationBox& box, int bits, draco::EncoderBuffer& out);

}  // namespace papilio::proto::edgebreaker
