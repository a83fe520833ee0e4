#pragma once

#include <draco/core/encoder_buffer.h>

#include "proto/edgebreaker/surface.h"
#include "proto/edgebreaker/vertex_order.h"
#include "proto/quantization_box.h"

namespace papilio::proto::edgebreaker {

/// Prediction of a position from the positions before it.
enum class Prediction : int8_t {
  difference = 0,     ///< the previous position
  parallelogram = 1,  ///< completion of the opposite face to a parallelogram, else the previous position
};

/// Point of the grid, or a vector in grid steps; the fourth lane is 0. GCC and Clang support vector types on every
/// target.
using GridPoint = int32_t __attribute__((vector_size(16)));

/// Quantizes the positions of the surface's vertices to the grid of 2^bits steps along the box.
[[nodiscard]] Buffer<GridPoint> to_grid(const Buffer<Vec3f>& positions, const Surface& surface,
                                        const QuantizationBox& box, int bits);

/// Returns the bounding box of the positions that a decoder makes of points of the grid.
[[nodiscard]] Box decoded_box(const Buffer<GridPoint>& points, const QuantizationBox& box, int bits);

/// Writes the positions [vertices] in the given order as differences from their predictions. `compression_level`: of
/// Draco's entropy coder, 0 to 10. `poller` steps once a value.
void write_positions(const CornerMesh& mesh, const VertexOrder& order, const Buffer<GridPoint>& values,
                     Prediction prediction, int compression_level, Poller& poller, draco::EncoderBuffer& out);

/// Writes the positions in the order of `corners` as libdraco does at `speed` 0 and 1. The prediction is the best mean
/// of up to four parallelograms, or a single parallelogram for a mesh with few `points`.
void write_positions_multi_parallelogram(const CornerMesh& mesh, const Buffer<uint32_t>& corners,
                                         const Buffer<GridPoint>& values, int speed, uint32_t points, Poller& poller,
                                         draco::EncoderBuffer& out);

/// Writes the mesh's positions as floats in the order of `corners`.
void write_positions_exactly(const Buffer<Vec3f>& positions, const Surface& surface, const Buffer<uint32_t>& corners,
                             Poller& poller, draco::EncoderBuffer& out);

/// Writes the parameters with which a decoder dequantizes positions.
void write_grid(const QuantizationBox& box, int bits, draco::EncoderBuffer& out);

}  // namespace papilio::proto::edgebreaker
