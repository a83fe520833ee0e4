#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "proto/output_attribute.h"

// Writer of Draco 2.2 edgebreaker streams from half-edges and positions. libdraco would first rebuild the connectivity,
// in time quadratic in the valence; here the work is near-linear in the faces at any valence. The bytes are libdraco's,
// except for non-manifold meshes and for integers too large for its entropy coder (output_attribute.h).

namespace papilio::proto::edgebreaker {

/// Writes the mesh with quantized positions. Calls `poll`, unless empty, every few milliseconds; it may throw to stop.
[[nodiscard]] std::string write(const Mesh& mesh, const QuantizationBox& box, const OutputOptions& options,
                                uint32_t position_id, std::span<const OutputAttribute> attributes = {},
                                const std::function<void()>& poll = {});

/// Stream, and a description of the mesh that a reader decodes from it.
struct WrittenStream {
  std::string bytes;
  uint32_t points = 0, faces = 0;
  Box box{};  ///< bounding box of the decoded positions
};

/// Writes the mesh as write() does, and frees arrays of the mesh and its attributes once they are read.
[[nodiscard]] WrittenStream write_and_free(Mesh mesh, const QuantizationBox& box, const OutputOptions& options,
                                           uint32_t position_id, std::vector<OutputAttribute> attributes,
                                           const std::function<void()>& poll);

/// Writes the mesh with exact positions, at speed 5. Attributes must not be predicted from positions
/// (`exact_attribute`).
[[nodiscard]] std::string write_exact(const Mesh& mesh, uint32_t position_id,
                                      std::span<const OutputAttribute> attributes);

}  // namespace papilio::proto::edgebreaker
