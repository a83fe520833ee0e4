#include "proto/detail/packed_texcoords.h"

namespace papilio::proto::detail {
namespace {

/// Draco's unique id of texture coordinates in a base; that of the positions is 0.
constexpr uint32_t texcoord_id = 1;

}  // namespace

void turn_over(Attribute& texcoords) {
  for (size_t i = 1; i < texcoords.values.size(); i += 2) texcoords.values[i] = 1 - texcoords.values[i];
}

MeshFormat base_format(const std::vector<Attribute>& attributes) {
  MeshFormat format;
  for (const Attribute& attribute : attributes) {
    if (attribute.unit_length)
      append_normals(format);
    else
      format.attributes.push_back({.kind = AttributeKind::tex_coord, .type = ValueType::float32, .id = texcoord_id});
  }
  return format;
}

std::optional<Attribute> texcoords_to_pack(const FormattedMesh& mesh) {
  for (size_t a = 0; a < mesh.format.attributes.size(); ++a) {
    if (mesh.format.attributes[a].kind != AttributeKind::tex_coord || mesh.attributes[a].components != 2) continue;
    Attribute texcoords = mesh.attributes[a];
    turn_over(texcoords);
    return texcoords;
  }
  return std::nullopt;
}

}  // namespace papilio::proto::detail
