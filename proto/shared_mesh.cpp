#include "proto/shared_mesh.h"

#include <utility>

#include "proto/detail/find_packed.h"
#include "proto/detail/packed_texcoords.h"
#include "proto/draco_reader.h"
#include "proto/error_translation.h"

namespace papilio::proto {
namespace {

/// Upper bound by which values of detail levels may exceed the base's range, a share of the range.
constexpr float beyond_base = 0.25F;

void widen(AttributeEncoding::Grid& grid) {
  for (float& lowest : grid.origin) lowest -= beyond_base * grid.range;
  grid.range *= 1 + 2 * beyond_base;
}

}  // namespace

DecodedMesh decode_mesh(std::string_view bytes, const Limits& limits) {
  DecodedMesh decoded;
  translate_errors([&] {
    if (auto model = detail::find_packed(bytes, limits)) {
      TriangleMesh base = model->base.triangles;
      detail::turn_over(base.attributes);
      decoded.mesh = build_mesh(base, &decoded.found);
      decoded.attributes = attribute_encoding(decoded.mesh, detail::base_format(base.attributes));
      for (AttributeEncoding::Grid& grid : decoded.attributes.grids) widen(grid);
      decoded.normals = model->normals;
      detail::attach_levels_turned_over(decoded.mesh, std::move(*model));
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
