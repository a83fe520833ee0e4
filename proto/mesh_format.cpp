#include "proto/mesh_format.h"

#include <algorithm>
#include <cmath>

namespace papilio::proto {

bool is_unit_normal(const AttributeFormat& format, uint32_t components) {
  return format.kind == AttributeKind::normal && format.type == ValueType::float32 && components == 3;
}

bool is_smoothing_group(const AttributeFormat& format, uint32_t components) {
  return format.kind == AttributeKind::generic && format.type <= ValueType::uint64 && components == 1 &&
         format.name == smoothing_group_name;
}

double unit_value(const AttributeFormat& format) {
  if (!format.normalized || format.type > ValueType::uint64) return 1;
  const auto number = static_cast<unsigned>(format.type);  // int8, uint8, int16, uint16, ...
  const int bits = 8 << (number / 2);
  return std::ldexp(1.0, number % 2 == 0 ? bits - 1 : bits) - 1;
}

void append_normals(MeshFormat& format) {
  AttributeFormat normals{.kind = AttributeKind::normal};
  while (normals.id == format.position_id ||
         std::ranges::count(format.attributes, normals.id, &AttributeFormat::id) > 0)
    ++normals.id;
  format.attributes.push_back(normals);
}

}  // namespace papilio::proto
