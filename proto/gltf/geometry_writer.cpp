#include "proto/gltf/geometry_writer.h"

#include <optional>
#include <tuple>
#include <utility>

#include "proto/gltf/extension_lists.h"
#include "proto/gltf/extensions.h"
#include "proto/gltf/slots.h"

namespace papilio::proto::gltf {
namespace {

std::vector<PrimitivePlace> places_of(const std::vector<EncodedGeometry>& meshes) {
  std::vector<PrimitivePlace> places;
  for (const EncodedGeometry& mesh : meshes)
    for (const EncodedPrimitive& primitive : mesh.primitives) places.push_back({mesh.mesh, primitive.number});
  return places;
}

class GeometryWriter {
 public:
  GeometryWriter(Document& document, const std::vector<EncodedGeometry>& meshes, Compression compression)
      : document_(document),
        compression_(compression),
        slots_(document, find_released(document.json, places_of(meshes))) {}

  void write(EncodedGeometry mesh) {
    std::vector<Json> attributes(mesh.sets.size()), targets(mesh.sets.size());
    for (EncodedPrimitive& primitive : mesh.primitives) {
      Json& json = document_.json["meshes"][mesh.mesh]["primitives"][primitive.number];
      if (primitive.draco) {
        write_draco_primitive(json, std::move(*primitive.draco));
      } else {
        if (attributes[primitive.set].is_null())
          std::tie(attributes[primitive.set], targets[primitive.set]) = put_vertices(json, mesh.sets[primitive.set]);
        json["indices"] = slots_.put(std::move(primitive.indices), Use::indices);
        json["attributes"] = attributes[primitive.set];
        if (!targets[primitive.set].is_null()) json["targets"] = targets[primitive.set];
        erase_extension(json, draco_extension);
      }
      json.erase("mode");
      erase_extension(json, detail_extension);  // its residuals belong to the old triangles
    }
  }

  BufferPieces finish() {
    if (compression_ == Compression::none) slots_.decompress_rest();
    BufferPieces pieces = slots_.finish();
    list_extensions(document_.json);
    return pieces;
  }

 private:
  /// Writes the vertices of a set. Returns the attributes and the morph targets of its primitives.
  std::pair<Json, Json> put_vertices(const Json& primitive, EncodedSet& set) {
    Json attributes = primitive["attributes"];
    Json targets = primitive.value("targets", Json());
    const auto put = [&](EncodedStream& stream) { return slots_.put(std::move(stream.elements), Use::vertices); };
    for (EncodedStream& stream : set.attributes) attributes[stream.semantic] = put(stream);
    for (size_t t = 0; t < set.targets.size(); ++t)
      for (EncodedStream& stream : set.targets[t]) targets[t][stream.semantic] = put(stream);
    return {std::move(attributes), std::move(targets)};
  }

  void write_draco_primitive(Json& json, DracoContent draco) {
    Json ids = Json::object();
    for (const auto& [semantic, id] : draco.ids) ids[semantic] = id;
    for (const auto& [semantic, summary] : draco.attributes) json["attributes"][semantic] = slots_.describe(summary);
    json["indices"] = slots_.describe(draco.indices);
    std::optional<uint32_t> old_view;
    if (const Json* extension = find_extension(json, draco_extension, "a primitive"))
      old_view = (*extension)["bufferView"].get<uint32_t>();
    json["extensions"][draco_extension] = {{"bufferView", slots_.put_stream(old_view, std::move(draco.stream))},
                                           {"attributes", std::move(ids)}};
  }

  Document& document_;
  Compression compression_;
  Slots slots_;
};

}  // namespace

BufferPieces write_geometry(Document& document, std::vector<EncodedGeometry> meshes, Compression compression) {
  require_sound_views(document);
  GeometryWriter writer(document, meshes, compression);
  for (EncodedGeometry& mesh : meshes) writer.write(std::exchange(mesh, {}));
  return writer.finish();
}

BufferPieces remove_detail(Document& document) {
  require_sound_views(document);
  const std::vector<uint32_t> views = find_detail_views(document.json);
  for (Json& mesh : document.json["meshes"])
    for (Json& primitive : mesh["primitives"]) erase_extension(primitive, detail_extension);
  list_extensions(document.json);
  return replace_contents(document, {}, views);
}

}  // namespace papilio::proto::gltf
