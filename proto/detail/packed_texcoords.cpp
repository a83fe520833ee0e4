#include "proto/detail/packed_texcoords.h"

#include "proto/gltf/material_attribute.h"

namespace papilio::proto::detail {
namespace {

/// Draco's unique ids of texture coordinates in a base, and of parts in a mesh; that of the positions is 0.
constexpr uint32_t texcoord_id = 1, part_id = 2;

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
    else
      format.attributes.push_back({.kind = AttributeKind::tex_coord, .type = ValueType::float32, .id = texcoord_id});
  }
  return format;
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
