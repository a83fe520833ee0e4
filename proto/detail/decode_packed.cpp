#include "proto/detail/decode_packed.h"

#include "proto/detail/packed_texcoords.h"

namespace papilio::proto::detail {

FormattedMesh decode_packed(const PackedModel& model, const DecodeOptions& options) {
  Mesh decoded = decode_detail(model.base, model.streams(), options.face_limit, options.cancelled);
  FormattedMesh mesh;
  mesh.format = base_format(decoded.attributes.attributes);
  turn_over(decoded.attributes.attributes);
  round_colours(decoded.attributes.attributes);
  if (add_detail_normals(decoded, options.normals.value_or(model.normals))) append_normals(mesh.format);
  static_cast<TriangleMesh&>(mesh) = std::move(decoded).triangles();
  return mesh;
}

}  // namespace papilio::proto::detail
