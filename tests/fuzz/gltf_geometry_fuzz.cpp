#include <algorithm>
#include <bit>
#include <optional>

#include "proto/gltf/document_writer.h"
#include "proto/gltf/flattening.h"
#include "proto/gltf/geometry_writer.h"
#include "proto/gltf/vertices.h"
#include "tests/fuzz/fuzz.h"

// The JSON of a scene, a zero, its binary chunk: geometry that is read can be replaced under each compression, and is
// equal when read again. A scene that can be flattened, with its materials, can be converted to a scene again.

using namespace papilio;
using namespace papilio::proto::gltf;

namespace {

constexpr proto::Limits small{.max_input_faces = 5000, .max_input_vertices = 5000};

std::vector<MeshGeometry> read_all(const Document& document) {
  Views views(document);
  Allowance allowance(small);
  std::vector<MeshGeometry> all;
  for (uint32_t m = 0; m < array_of(document.json, "meshes").size(); ++m)
    all.push_back(read_geometry(views, m, allowance));
  return all;
}

/// Returns the bits of the positions of all corners; for a Draco stream, which is encoded again, only their number.
std::vector<std::array<uint32_t, 3>> corners(const MeshGeometry& geometry) {
  std::vector<std::array<uint32_t, 3>> all;
  for (const TrianglePrimitive& primitive : geometry.primitives) {
    const Buffer<Vec3f> positions = vertex_positions(geometry.sets[primitive.set]);
    for (const Triangle& triangle : primitive.triangles)
      for (const uint32_t v : triangle)
        all.push_back({std::bit_cast<uint32_t>(positions[v].x), std::bit_cast<uint32_t>(positions[v].y),
                       std::bit_cast<uint32_t>(positions[v].z)});
  }
  return all;
}

/// Replaces all geometry by itself, and reads it again.
std::vector<MeshGeometry> rewritten(Document document, const std::vector<MeshGeometry>& before,
                                    Compression compression) {
  std::vector<EncodedGeometry> same;
  for (uint32_t m = 0; m < before.size(); ++m)
    if (!before[m].primitives.empty())
      same.push_back(encode_geometry(document,
                                     {m, before[m], proto::quantization_box(vertex_positions(before[m].sets[0]))},
                                     {.compression = compression, .draco = {}, .poll = {}}));
  BufferPieces pieces = write_geometry(document, std::move(same), compression);
  const std::string written = write_document(document, std::move(pieces), FileKind::glb).document;
  std::vector<MeshGeometry> after = read_all(read_document(written));
  fuzz::require(after.size() == before.size(), "meshes survive");
  return after;
}

void round_trip(const std::string& glb) {
  const Document document = read_document(glb);
  const std::vector<MeshGeometry> before = read_all(document);
  const std::vector<MeshGeometry> plain = rewritten(document, before, Compression::none);
  for (size_t m = 0; m < before.size(); ++m)
    fuzz::require(corners(plain[m]) == corners(before[m]), "triangles survive to the bit");
  const std::vector<MeshGeometry> meshopt = rewritten(document, before, Compression::meshopt);
  for (size_t m = 0; m < before.size(); ++m)
    fuzz::require(corners(meshopt[m]).size() == corners(before[m]).size(), "triangles survive");
  (void)rewritten(document, before, Compression::draco);  // without degenerate triangles
}

void flatten(const std::string& glb) {
  const MaterialMesh flat = flatten_with_materials(glb, small);
  const MaterialMesh again = flatten_with_materials(scene_of_mesh(flat.mesh, flat.materials), {});
  fuzz::require(again.mesh.triangles.size() == flat.mesh.triangles.size(), "triangles survive");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto [json, binary] = fuzz::cut(fuzz::text_of(data, size), '\0');
  const std::string glb = write_glb(json, std::vector<Piece>{{binary}}, {});
  (void)fuzz::unless_refused([&] { round_trip(glb); });
  (void)fuzz::unless_refused([&] { flatten(glb); });
  return 0;
}
