#include "proto/detail/packed_texcoords.h"

namespace papilio::proto::detail {
namespace {

/// Draco's unique id of texture coordinates in a base; that of the positions is 0.
constexpr uint32_t texcoord_id = 1;

}  // namespace

void turn_over(Attribute& texcoords) {
  for (size_t i = 1; i < texcoords.values.size(); i += 2) texcoords.values[i] = 1 - texcoords.values[i];
}

MeshFormat base_format(const TriangleMesh& base) {
  MeshFormat format;
  if (!base.attributes.empty())
    format.attributes.push_back({.kind = AttributeKind::tex_coord, .type = ValueType::float32, .id = texcoord_id});
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

FormattedMesh decode_packed(const PackedModel& model, uint64_t face_limit, const std::function<bool()>& cancelled) {
  FormattedMesh mesh;
  static_cast<TriangleMesh&>(mesh) = decode_detail(model.base, model.streams(), face_limit, cancelled);
  mesh.format = base_format(mesh);
  for (Attribute& texcoords : mesh.attributes) turn_over(texcoords);
  return mesh;
}

}  // namespace papilio::proto::detail
