#include "proto/gltf/material_attribute.h"

#include <algorithm>
#include <unordered_map>

namespace papilio::proto::gltf {
namespace {

/// Splits points between materials. Returns the material of each point.
std::vector<uint32_t> divide_points(FormattedMesh& mesh, const std::vector<uint32_t>& of_triangle) {
  std::vector<uint32_t> owner(mesh.positions.size(), none);
  std::vector<bool> is_owned(mesh.positions.size());
  std::unordered_map<uint64_t, uint32_t> copies;  // by point and material, for points of another material
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    for (uint32_t& point : mesh.triangles[t]) {
      if (!is_owned[point]) {
        is_owned[point] = true;
        owner[point] = of_triangle.at(t);
      }
      if (owner[point] == of_triangle[t]) continue;
      const auto [copy, is_new] =
          copies.try_emplace(uint64_t{point} << 32 | of_triangle[t], static_cast<uint32_t>(mesh.positions.size()));
      if (is_new) {
        mesh.positions.push_back(Vec3f(mesh.positions[point]));
        owner.push_back(of_triangle[t]);
        is_owned.push_back(true);
        for (Attribute& attribute : mesh.attributes)
          for (uint32_t c = 0; c < attribute.components; ++c)
            attribute.values.push_back(double{attribute.values[size_t{point} * attribute.components + c]});
      }
      point = copy->second;
    }
  return owner;
}

bool is_material(const AttributeFormat& format) {
  return format.kind == AttributeKind::generic && format.name == material_attribute_name;
}

}  // namespace

AttributeFormat material_format(uint32_t id) {
  return {.kind = AttributeKind::generic, .type = ValueType::int32, .id = id, .name = material_attribute_name};
}

bool has_material_attribute(const FormattedMesh& mesh) {
  return std::ranges::any_of(mesh.format.attributes, is_material);
}

void add_material_attribute(MaterialMesh& model) {
  const std::vector<uint32_t> owner = divide_points(model.mesh, model.materials.of_triangle);
  uint32_t id = 0;
  for (const AttributeFormat& format : model.mesh.format.attributes) id = std::max(id, format.id);
  Attribute& attribute = model.mesh.attributes.emplace_back();
  attribute.values.reserve(owner.size());
  for (const uint32_t material : owner)
    attribute.values.push_back(material == none ? 0.0 : static_cast<double>(material) + 1);
  model.mesh.format.attributes.push_back(material_format(id + 1));
}

std::vector<uint32_t> take_material_attribute(FormattedMesh& mesh, size_t count) {
  std::vector<uint32_t> of_triangle(mesh.triangles.size(), none);
  const auto format = std::ranges::find_if(mesh.format.attributes, is_material);
  if (format == mesh.format.attributes.end()) return of_triangle;
  const auto attribute = mesh.attributes.begin() + (format - mesh.format.attributes.begin());
  for (size_t t = 0; t < of_triangle.size(); ++t) {
    const double number = attribute->values[size_t{mesh.triangles[t][0]} * attribute->components];
    if (number >= 1 && number <= static_cast<double>(count)) of_triangle[t] = static_cast<uint32_t>(number) - 1;
  }
  mesh.attributes.erase(attribute);
  mesh.format.attributes.erase(format);
  return of_triangle;
}

}  // namespace papilio::proto::gltf
