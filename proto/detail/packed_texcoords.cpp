#include "proto/detail/packed_texcoords.h"

#include <algorithm>
#include <cmath>

#include "proto/gltf/material_attribute.h"

namespace papilio::proto::detail {
namespace {

/// Draco's unique ids of attributes in a base. The id of positions is 0.
constexpr uint32_t texcoord_id = 1, part_id = 2, colour_id = 3;
constexpr double most_of_byte = 255;

/// Returns whether an attribute of a base holds colours.
bool are_colours(const Attribute& attribute) { return attribute.components == 3 && !attribute.unit_length; }

/// Returns the index of the first colours of a mesh, or the number of its attributes.
size_t find_colours(const FormattedMesh& mesh) {
  size_t a = 0;
  while (a < mesh.attributes.size() &&
         (mesh.format.attributes[a].kind != AttributeKind::color || mesh.attributes[a].components < 3))
    ++a;
  return a;
}

double to_byte(double value) { return std::clamp(std::floor(value + 0.5), 0.0, most_of_byte); }

void turn_values_over(Attribute& texcoords) {
  for (size_t i = 1; i < texcoords.values.size(); i += 2) texcoords.values[i] = 1 - texcoords.values[i];
}

}  // namespace

void turn_over(std::vector<Attribute>& attributes) {
  for (Attribute& attribute : attributes)
    if (attribute.components == 2) turn_values_over(attribute);
}

MeshFormat base_format(const std::vector<Attribute>& attributes) {
  MeshFormat format;
  for (const Attribute& attribute : attributes) {
    if (attribute.unit_length)
      append_normals(format);
    else if (attribute.components == 1)
      format.attributes.push_back(gltf::material_format(part_id));
    else if (are_colours(attribute))
      format.attributes.push_back(
          {.kind = AttributeKind::color, .type = ValueType::uint8, .normalized = true, .id = colour_id});
    else
      format.attributes.push_back({.kind = AttributeKind::tex_coord, .type = ValueType::float32, .id = texcoord_id});
  }
  return format;
}

std::optional<Attribute> colours_to_pack(const FormattedMesh& mesh) {
  const size_t a = find_colours(mesh);
  if (a == mesh.attributes.size()) return std::nullopt;
  const Attribute& of = mesh.attributes[a];
  const double unit = unit_value(mesh.format.attributes[a]);
  Attribute colours{.components = 3, .values = {}};
  for (size_t i = 0; i < of.values.size(); ++i)
    if (i % of.components < 3) colours.values.push_back(to_byte(of.values[i] / unit * most_of_byte));
  return colours;
}

bool has_opacity(const FormattedMesh& mesh) {
  const size_t a = find_colours(mesh);
  if (a == mesh.attributes.size() || mesh.attributes[a].components != 4) return false;
  const std::vector<double>& values = mesh.attributes[a].values;
  for (size_t i = 3; i < values.size(); i += 4)
    if (values[i] < unit_value(mesh.format.attributes[a])) return true;
  return false;
}

void round_colours(std::vector<Attribute>& attributes) {
  for (Attribute& attribute : attributes)
    if (are_colours(attribute)) std::ranges::transform(attribute.values, attribute.values.begin(), to_byte);
}

std::optional<Attribute> texcoords_to_pack(const FormattedMesh& mesh) {
  for (size_t a = 0; a < mesh.format.attributes.size(); ++a) {
    if (mesh.format.attributes[a].kind != AttributeKind::tex_coord || mesh.attributes[a].components != 2) continue;
    Attribute texcoords = mesh.attributes[a];
    turn_values_over(texcoords);
    return texcoords;
  }
  return std::nullopt;
}

}  // namespace papilio::proto::detail
