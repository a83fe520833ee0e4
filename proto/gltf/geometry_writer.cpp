#include "proto/gltf/geometry_writer.h"

#include <utility>

#include "proto/gltf/draco_primitive.h"
#include "proto/gltf/extension_lists.h"
#include "proto/gltf/extensions.h"
#include "proto/gltf/slots.h"

namespace papilio::proto::gltf {
namespace {

/// Smallest index that restarts primitives where indices have 16 bits.
constexpr uint64_t restart_index_16 = 65535;

Elements index_elements(const Buffer<Triangle>& triangles, uint64_t vertices) {
  const ComponentType type = vertices <= restart_index_16 ? ComponentType::uint16 : ComponentType::uint32;
  Elements out = zero_elements({type, 1, false}, 3 * triangles.size());
  for (size_t i = 0; i < 3 * triangles.size(); ++i) out.set_number(i, 0, triangles[i / 3][i % 3]);
  return out;
}

std::vector<PrimitivePlace> places_of(const std::vector<NewGeometry>& meshes) {
  std::vector<PrimitivePlace> places;
  for (const NewGeometry& mesh : meshes)
    for (const TrianglePrimitive& primitive : mesh.geometry.primitives) places.push_back({mesh.mesh, primitive.number});
  return places;
}

class GeometryWriter {
 public:
  GeometryWriter(Document& document, const std::vector<NewGeometry>& meshes, const GeometryEncoding& encoding)
      : document_(document), encoding_(encoding), slots_(document, find_released(document.json, places_of(meshes))) {}

  void write(NewGeometry mesh) {
    std::vector<Json> attributes(mesh.geometry.sets.size()), targets(mesh.geometry.sets.size());
    for (const TrianglePrimitive& primitive : mesh.geometry.primitives) {
      if (encoding_.poll) encoding_.poll();
      Json& json = document_.json["meshes"][mesh.mesh]["primitives"][primitive.number];
      VertexSet& set = mesh.geometry.sets[primitive.set];
      const Compression compression = compression_of(json, set);
      if (compression == Compression::draco && set.targets.empty())
        write_draco_primitive(json, set, primitive, mesh.box);
      else
        write_plain(json, set, primitive, compression == Compression::meshopt, attributes[primitive.set],
                    targets[primitive.set]);
      json.erase("mode");
    }
  }

  BufferPieces finish() {
    if (encoding_.compression == Compression::none) slots_.decompress_rest();
    BufferPieces pieces = slots_.finish();
    list_extensions(document_.json);
    return pieces;
  }

 private:
  [[nodiscard]] Compression compression_of(const Json& primitive, const VertexSet& set) const {
    if (encoding_.compression != Compression::same) return encoding_.compression;
    if (find_extension(primitive, draco_extension, "a primitive") != nullptr) return Compression::draco;
    return slots_.is_compressed(set.find("POSITION")->accessor.value()) ? Compression::meshopt : Compression::none;
  }

  /// Writes a primitive without Draco. `attributes`, `targets`: of its set, written with the first primitive of it.
  void write_plain(Json& json, const VertexSet& set, const TrianglePrimitive& primitive, bool meshopt, Json& attributes,
                   Json& targets) {
    if (attributes.is_null()) {
      attributes = json["attributes"];
      if (json.contains("targets")) targets = json["targets"];
      for (const VertexStream& stream : set.attributes)
        attributes[stream.semantic] = slots_.put(stream.accessor, stream.elements, Use::vertices, meshopt);
      for (size_t t = 0; t < set.targets.size(); ++t)
        for (const VertexStream& stream : set.targets[t])
          targets[t][stream.semantic] = slots_.put(stream.accessor, stream.elements, Use::vertices, meshopt);
    }
    put_indices(json, index_elements(primitive.triangles, set.count), meshopt);
    json["attributes"] = attributes;
    if (!targets.is_null()) json["targets"] = targets;
    erase_draco(json);
  }

  void put_indices(Json& json, const Elements& indices, bool meshopt) {
    const auto old = index_member(json, "indices", "a primitive");
    json["indices"] = slots_.put(old, indices, Use::indices, meshopt);
  }

  void write_draco_primitive(Json& json, const VertexSet& set, const TrianglePrimitive& primitive,
                             const QuantizationBox& box) {
    EncodedPrimitive made = encode_draco_primitive(set, primitive.triangles, box, encoding_.draco, encoding_.poll);
    Json ids = Json::object();
    for (const auto& [semantic, id] : made.ids) ids[semantic] = id;
    for (const VertexStream& stream : made.decoded.attributes)
      json["attributes"][stream.semantic] = slots_.describe(stream.accessor, stream.elements);
    const auto old = index_member(json, "indices", "a primitive");
    json["indices"] = slots_.describe(old, index_elements(made.decoded.triangles, made.decoded.count));
    std::optional<uint32_t> old_view;
    if (const Json* extension = find_extension(json, draco_extension, "a primitive"))
      old_view = (*extension)["bufferView"].get<uint32_t>();
    json["extensions"][draco_extension] = {{"bufferView", slots_.put_stream(old_view, std::move(made.stream))},
                                           {"attributes", std::move(ids)}};
  }

  static void erase_draco(Json& json) {
    if (!json.contains("extensions")) return;
    json["extensions"].erase(draco_extension);
    if (json["extensions"].empty()) json.erase("extensions");
  }

  Document& document_;
  const GeometryEncoding& encoding_;
  Slots slots_;
};

}  // namespace

BufferPieces write_geometry(Document& document, std::vector<NewGeometry> meshes, const GeometryEncoding& encoding) {
  require_sound_views(document);
  GeometryWriter writer(document, meshes, encoding);
  for (NewGeometry& mesh : meshes) writer.write(std::exchange(mesh, {}));
  return writer.finish();
}

}  // namespace papilio::proto::gltf
