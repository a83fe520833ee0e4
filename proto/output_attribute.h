#pragma once

#include <vector>

#include "proto/draco_attributes.h"
#include "proto/draco_writer.h"

// Attributes of a stream besides positions, with their codings. For the writers only.

namespace papilio::proto {

/// Coding of an attribute's numbers, in Draco's order.
enum class Coding : uint8_t {
  as_is,       ///< raw: 64-bit numbers, booleans, floats whose range overflows
  integers,    ///< predicted integers of up to 32 bits
  grid,        ///< floats quantized to a grid, then predicted
  octahedral,  ///< unit normals quantized on the unfolded octahedron, then predicted
};

/// Attribute of a stream.
struct OutputAttribute {
  AttributeFormat format{};
  uint32_t components = 3;
  Coding coding = Coding::as_is;
  int bits = 0;                    ///< bits of a component on the grid or octahedron
  AttributeEncoding::Grid grid{};  ///< grid of Coding::grid
  bool is_too_large = false;       ///< whether integers exceed the range of Draco's entropy coder
  StoredValues values{};
};

/// Returns an attribute with values [points], in the coding that its format and grid allow.
[[nodiscard]] OutputAttribute output_attribute(const Attribute& attribute, const AttributeFormat& format,
                                               const AttributeEncoding::Grid& grid, const VertexPoints& points);

/// Returns the attributes that `encoding` describes.
[[nodiscard]] std::vector<OutputAttribute> output_attributes(const Mesh& mesh, const AttributeEncoding& encoding);

/// Returns an attribute of the mesh with exact values.
[[nodiscard]] OutputAttribute exact_attribute(const Attribute& attribute, const AttributeFormat& format,
                                              const VertexPoints& points);

}  // namespace papilio::proto
