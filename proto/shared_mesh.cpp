#include "proto/shared_mesh.h"

#include <utility>

#include "proto/detail/find_packed.h"
#include "proto/draco_reader.h"
#include "proto/error_translation.h"

namespace papilio::proto {

DecodedMesh decode_mesh(std::string_view bytes, const Limits& limits) {
  DecodedMesh decoded;
  translate_errors([&] {
    if (auto model = detail::find_packed(bytes, limits)) {
      decoded.mesh = build_mesh(model->base.triangles, &decoded.found);
      detail::attach_levels(decoded.mesh, std::move(*model));
    } else {
      FormattedMesh input = read_draco(bytes, limits);
      decoded.mesh = build_mesh(input, &decoded.found, rounding_gap);
      decoded.attributes = attribute_encoding(decoded.mesh, std::move(input.format));
    }
  });
  decoded.box = quantization_box(decoded.mesh.positions);
  return decoded;
}

SharedMesh::SharedMesh(std::string_view bytes, const Limits& limits, uint64_t byte_budget)
    : decoded_(decode_mesh(bytes, limits)), prepared_(byte_budget) {}

}  // namespace papilio::proto
