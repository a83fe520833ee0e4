#pragma once

#include <draco/core/encoder_buffer.h>

#include "proto/edgebreaker/positions.h"
#include "proto/edgebreaker/seams.h"
#include "proto/output_attribute.h"

// Attributes other than positions. Predictions are libdraco's: there are many kinds, and they seldom cost much.

namespace papilio::proto::edgebreaker {

/// Writes the declaration of an attribute: kind, type, components and id.
void write_declaration(const OutputAttribute& attribute, draco::EncoderBuffer& out);

/// Surface with its walk, and its positions as written.
struct WrittenSurface {
  const CornerMesh& mesh;
  const Buffer<uint32_t>& corner_point;  ///< [corners] point of the mesh at each corner
  const Buffer<uint32_t>& starts;        ///< [faces] entry corners (connectivity.h)
  const VertexOrder& order;              ///< order of values without seams
  const Buffer<GridPoint>& positions;    ///< [vertices] quantized positions; empty: positions are exact
  uint32_t points;                       ///< points of the mesh
};

/// Writes the values of an attribute: raw, or as differences from the predictions of Draco's `speed`, 0 to 10.
void write_values(const OutputAttribute& attribute, const Seams& seams, const WrittenSurface& written, int speed,
                  Poller& poller, draco::EncoderBuffer& out);

/// Writes the parameters with which a decoder dequantizes values.
void write_quantization(const OutputAttribute& attribute, draco::EncoderBuffer& out);

}  // namespace papilio::proto::edgebreaker
