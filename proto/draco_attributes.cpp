#include "proto/draco_attributes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <type_traits>

#include "proto/draco_header.h"
#include "proto/problem.h"

namespace papilio::proto {
namespace {

// A skinned glTF model (tangents, two texture coordinates, colours, joints, weights) has 20 components.
constexpr uint64_t most_attributes = 16;
constexpr uint64_t most_components = 32;
constexpr size_t longest_name = 256;

static_assert(draco::GeometryAttribute::NORMAL == 1 + static_cast<int>(AttributeKind::normal));
static_assert(draco::GeometryAttribute::GENERIC == 1 + static_cast<int>(AttributeKind::generic));
static_assert(draco::DT_INT8 == 1 + static_cast<int>(ValueType::int8));
static_assert(draco::DT_BOOL == 1 + static_cast<int>(ValueType::boolean));

ValueType type_of(const draco::PointAttribute& attribute) {
  if (attribute.data_type() <= draco::DT_INVALID || attribute.data_type() > draco::DT_BOOL)
    throw Problem(Code::mesh_not_draco, "Attribute " + std::to_string(attribute.unique_id()) + " has data type " +
                                            std::to_string(attribute.data_type()) + "; Draco has 1 to " +
                                            std::to_string(draco::DT_BOOL) + ". Encode the mesh again.");
  return static_cast<ValueType>(attribute.data_type() - 1);
}

AttributeFormat format_of(const draco::Mesh& mesh, int number) {
  const draco::PointAttribute& attribute = *mesh.attribute(number);
  AttributeFormat format;
  const int kind = attribute.attribute_type() - 1;
  format.kind = kind >= 0 && kind < static_cast<int>(AttributeKind::generic) ? static_cast<AttributeKind>(kind)
                                                                             : AttributeKind::generic;
  format.type = type_of(attribute);
  format.normalized = attribute.normalized();
  format.id = attribute.unique_id();
  const draco::AttributeMetadata* metadata = mesh.GetAttributeMetadataByAttributeId(number);
  if (metadata != nullptr && metadata->GetEntryString(name_entry, &format.name) && format.name.size() > longest_name)
    format.name.resize(longest_name);
  return format;
}

template <class Number>
std::vector<double> read_numbers(const draco::PointAttribute& attribute, uint32_t points) {
  const size_t components = attribute.num_components();
  std::vector<double> values;
  values.reserve(points * components);
  for (draco::PointIndex p(0); p < points; ++p) {
    const draco::AttributeValueIndex index = attribute.mapped_index(p);
    if (index.value() >= attribute.size())
      throw Problem(Code::mesh_unusable, "Point " + std::to_string(p.value()) + " has no value of attribute " +
                                             std::to_string(attribute.unique_id()) + ". Encode the mesh again.");
    const uint8_t* bytes = attribute.GetAddress(index);
    for (size_t i = 0; i < components; ++i) {
      using Stored =
          std::conditional_t<std::is_same_v<Number, bool>, uint8_t, Number>;  // other bytes than 0 and 1 occur
      Stored value;
      std::memcpy(&value, bytes + i * sizeof value, sizeof value);
      values.push_back(std::is_same_v<Number, bool> ? (value != 0 ? 1 : 0) : static_cast<double>(value));
    }
  }
  return values;
}

/// Returns the values of the points.
std::vector<double> read_values(const draco::PointAttribute& attribute, uint32_t points) {
  return with_number(type_of(attribute), [&](auto zero) { return read_numbers<decltype(zero)>(attribute, points); });
}

template <class Number>
Number nearest(double value) {
  if constexpr (std::is_same_v<Number, bool>) return value >= 0.5;
  using Range = std::numeric_limits<Number>;
  // Draco's encoder holds integers of up to 32 bits in an int32_t.
  constexpr Number highest =
      std::is_same_v<Number, uint32_t> ? static_cast<Number>(std::numeric_limits<int32_t>::max()) : Range::max();
  const double rounded = std::is_integral_v<Number> ? std::round(value) : value;
  if (rounded >= static_cast<double>(highest)) return highest;
  if (rounded <= static_cast<double>(Range::lowest())) return Range::lowest();
  return static_cast<Number>(rounded);
}

template <class Number>
std::vector<char> to_bytes(const std::vector<double>& values) {
  std::vector<char> bytes(values.size() * sizeof(Number));
  for (size_t i = 0; i < values.size(); ++i) {
    const auto number = nearest<Number>(values[i]);
    std::memcpy(bytes.data() + i * sizeof number, &number, sizeof number);
  }
  return bytes;
}

/// Returns for each point the first point of its vertex with an equal value. [points]
std::vector<uint32_t> find_equal(const std::vector<char>& bytes, size_t stride, const VertexPoints& points) {
  const std::vector<uint32_t>& vertex = points.vertex();
  std::vector<uint32_t> same(vertex.size());
  for (uint32_t p = 0; p < same.size(); ++p) same[p] = p;
  const auto compare = [&](uint32_t p, uint32_t q) {
    return std::memcmp(bytes.data() + p * stride, bytes.data() + q * stride, stride);
  };
  std::vector<uint32_t> order = points.on_seams();
  std::ranges::sort(order, [&](uint32_t p, uint32_t q) {
    if (vertex[p] != vertex[q]) return vertex[p] < vertex[q];
    const int difference = compare(p, q);
    return difference != 0 ? difference < 0 : p < q;
  });
  for (size_t i = 1; i < order.size(); ++i)
    if (vertex[order[i - 1]] == vertex[order[i]] && compare(order[i - 1], order[i]) == 0)
      same[order[i]] = same[order[i - 1]];
  return same;
}

}  // namespace

void require_attributes_within_limits(const draco::PointCloud& mesh) {
  uint64_t components = 0;
  for (int number = 0; number < mesh.num_attributes(); ++number) components += mesh.attribute(number)->num_components();
  require_within(static_cast<uint64_t>(mesh.num_attributes()), 1 + most_attributes, "attributes, positions included",
                 "Remove attributes.");
  require_within(components, 3 + most_components, "components of attributes, positions included", "Remove attributes.");
}

void read_attributes(const draco::Mesh& mesh, FormattedMesh& out) {
  for (int number = 0; number < mesh.num_attributes(); ++number) {
    const draco::PointAttribute& attribute = *mesh.attribute(number);
    if (attribute.attribute_type() == draco::GeometryAttribute::POSITION) {
      out.format.position_id = attribute.unique_id();
      continue;
    }
    const AttributeFormat format = format_of(mesh, number);
    Attribute& read = out.attributes.emplace_back();
    read.components = attribute.num_components();
    read.unit_length = is_unit_normal(format, read.components);
    read.is_smoothing_group = is_smoothing_group(format, read.components);
    read.values = read_values(attribute, static_cast<uint32_t>(out.positions.size()));
    out.format.attributes.push_back(format);
  }
}

VertexPoints::VertexPoints(const Mesh& mesh) : vertex_(mesh.attributes.point_count) {
  std::vector<uint32_t> first(mesh.topology.vertex_count, none);
  std::vector<bool> has_several(mesh.topology.vertex_count);
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
    const uint32_t v = mesh.topology.origin[h];
    const uint32_t p = mesh.attributes.point[h];
    vertex_[p] = v;
    if (first[v] == none) first[v] = p;
    if (first[v] != p) has_several[v] = true;
  }
  for (uint32_t p = 0; p < vertex_.size(); ++p)
    if (has_several[vertex_[p]]) on_seams_.push_back(p);
}

StoredValues store_values(const Attribute& attribute, const AttributeFormat& format, const VertexPoints& points) {
  StoredValues stored;
  stored.bytes = with_number(format.type, [&](auto zero) { return to_bytes<decltype(zero)>(attribute.values); });
  const auto count = static_cast<uint32_t>(points.vertex().size());
  const size_t stride = stored.bytes.size() / count;
  const std::vector<uint32_t> same = find_equal(stored.bytes, stride, points);
  stored.value.resize(count);
  uint32_t kept = 0;
  for (uint32_t p = 0; p < count; ++p) {
    stored.value[p] = same[p] == p ? kept : stored.value[same[p]];
    if (same[p] != p) continue;
    std::memmove(&stored.bytes[kept * stride], &stored.bytes[p * stride], stride);
    ++kept;
  }
  stored.bytes.resize(kept * stride);
  return stored;
}

draco::GeometryAttribute::Type draco_type(AttributeKind kind) {
  return static_cast<draco::GeometryAttribute::Type>(1 + static_cast<int>(kind));
}

draco::DataType draco_type(ValueType type) { return static_cast<draco::DataType>(1 + static_cast<int>(type)); }

}  // namespace papilio::proto
