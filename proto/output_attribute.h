#pragma once

#include <vector>

#include "proto/draco_attributes.h"
#include "proto/draco_writer.h"

// The attributes that a stream gets beside its positions, and how each is coded. For the writers only.

namespace papilio::proto {

/// What becomes of an attribute's numbers, in Draco's order.
enum class Coding : uint8_t {
  as_is,       ///< stored: floats of 64 bits, or with a range that is no float's, integers of 64 bits, booleans
  integers,    ///< of up to 32 bits: predicted
  grid,        ///< floats on a grid: then as integers
  octahedral,  ///< unit normals on the unfolded octahedron: predicted there
};

struct OutputAttribute {
  AttributeFormat format{};
  uint32_t components = 3;
  Coding coding = Coding::as_is;
  int bits = 0;                    ///< of a component on the grid or octahedron
  AttributeEncoding::Grid grid{};  ///< of Coding::grid
  bool is_too_large = false;       ///< integers that Draco's entropy coder cannot take
  /// `value` is empty where each vertex has its own, in their order: new normals.
  StoredValues values{};

  [[nodiscard]] bool has_value_per_vertex() const { return values.value.empty(); }
};

/// All that `encoding` describes of the mesh, but with new normals of the vertices in place of its own, if `options`
/// ask for normals.
[[nodiscard]] std::vector<OutputAttribute> output_attributes(const Mesh& mesh, const OutputOptions& options,
                                                             const AttributeEncoding& encoding);

/// One of the mesh's attributes to the bit.
[[nodiscard]] OutputAttribute exact_attribute(const Attribute& attribute, const AttributeFormat& format,
                                              const VertexPoints& points);

}  // namespace papilio::proto
