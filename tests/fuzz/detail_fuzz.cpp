#include <algorithm>
#include <string>
#include <vector>

#include "papilio/detail.h"
#include "proto/detail/packed_reader.h"
#include "proto/gltf/container.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/decoded_detail.h"

// A document and its binary chunk, separated by a zero, as a packed model: what is read has whole levels, and decodes
// to the declared faces and values. The first byte selects whether the file may be truncated, and the number of levels.

using namespace papilio;

namespace {

constexpr proto::Limits limits{.max_input_faces = 2000, .max_input_vertices = 2000, .max_output_faces = 20'000};

std::string glb_of(std::string_view text) {
  const auto [json, binary] = fuzz::cut(text, '\0');
  std::vector<proto::gltf::Piece> pieces;
  pieces.push_back({binary});
  return proto::gltf::write_glb(json, std::move(pieces), {});
}

void read_and_decode(uint8_t choice, std::string_view text) {
  std::string glb = glb_of(text);
  const bool may_be_cut = (choice & 1U) != 0;
  if (may_be_cut && (choice & 2U) != 0) glb.resize(glb.size() - glb.size() / 8);
  const size_t levels = choice >> 4U;
  const proto::detail::PackedModel model =
      proto::detail::read_packed(glb, {.limits = limits, .levels = levels, .may_be_cut = may_be_cut});
  fuzz::require(proto::detail::is_packed(glb), "what is read is packed");
  fuzz::require(model.levels.size() <= levels && model.levels.size() <= model.declared_levels, "no level is invented");
  fuzz::require(may_be_cut || model.levels.size() == std::min(levels, model.declared_levels), "no level is lost");
  const TriangleMesh fine = test::decoded_triangles(model.base, model.streams(), limits.max_output_faces);
  const uint64_t faces = model.levels.empty() ? model.base.triangles.triangles.size() : model.levels.back().faces;
  fuzz::require(fine.triangles.size() == faces, "the faces are those declared");
  const auto values = [](const TriangleMesh& mesh) {  // without part numbers, which the base's faces determine
    return std::ranges::count_if(mesh.attributes, [](const Attribute& attribute) { return attribute.components > 1; });
  };
  fuzz::require(values(fine) == values(model.base.triangles), "texture coordinates and colours are kept");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  (void)fuzz::unless_refused([&] { read_and_decode(data[0], fuzz::text_of(data + 1, size - 1)); });
  return 0;
}
