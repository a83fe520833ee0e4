#include "proto/output_attribute.h"

#include <algorithm>
#include <optional>

#include "papilio/mesh.h"

namespace papilio::proto {
namespace {

constexpr int normal_bits = 10;
// A quarter of a texel of a 4096 texture. At 12 bits, a whole texel, textures visibly shift on small faces.
constexpr int texture_bits = 14;
constexpr int value_bits = 16;  // other attributes
constexpr double largest_integer = 1 << 20;

bool is_integer_of_32_bits(ValueType type) { return type <= ValueType::uint32; }

/// Returns whether integers are too large for Draco's entropy coder. It allocates a table up to the largest symbol, and
/// crashes if predictions from 31-bit values overflow.
bool is_too_large(const Attribute& attribute, const AttributeFormat& format) {
  if (format.type != ValueType::int32 && format.type != ValueType::uint32) return false;
  const auto [low, high] = std::ranges::minmax(attribute.values);
  return std::max(-low, high) > largest_integer;
}

void choose_coding(OutputAttribute& output, const Attribute& attribute, const AttributeEncoding::Grid& grid) {
  const AttributeFormat& format = output.format;
  if (is_unit_normal(format, attribute.components)) {
    output.coding = Coding::octahedral;
    output.bits = normal_bits;
  } else if (format.type == ValueType::float32 && format.kind != AttributeKind::normal && grid.range > 0) {
    output.coding = Coding::grid;
    output.bits = format.kind == AttributeKind::tex_coord ? texture_bits : value_bits;
    output.grid = grid;
  }
}

}  // namespace

OutputAttribute exact_attribute(const Attribute& attribute, const AttributeFormat& format, const VertexPoints& points) {
  return {.format = format,
          .components = attribute.components,
          .coding = is_integer_of_32_bits(format.type) ? Coding::integers : Coding::as_is,
          .is_too_large = is_too_large(attribute, format),
          .values = store_values(attribute, format, points)};
}

OutputAttribute output_attribute(const Attribute& attribute, const AttributeFormat& format,
                                 const AttributeEncoding::Grid& grid, const VertexPoints& points) {
  OutputAttribute output = exact_attribute(attribute, format, points);
  choose_coding(output, attribute, grid);
  return output;
}

std::vector<OutputAttribute> output_attributes(const Mesh& mesh, const AttributeEncoding& encoding) {
  std::vector<OutputAttribute> outputs;
  std::optional<VertexPoints> points;
  for (size_t a = 0; a < encoding.format.attributes.size(); ++a) {
    if (!points) points.emplace(mesh);
    outputs.push_back(
        output_attribute(mesh.attributes.attributes[a], encoding.format.attributes[a], encoding.grids[a], *points));
  }
  return outputs;
}

}  // namespace papilio::proto
