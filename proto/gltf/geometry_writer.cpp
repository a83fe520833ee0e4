#include "proto/gltf/geometry_writer.h"

#include <tuple>
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

void erase_extension(Json& json, const char* name) {
  if (!json.contains("extensions")) return;
  json["extensions"].erase(name);
  if (json["extensions"].empty()) json.erase("extensions");
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
    std::vector<bool> needs_elements(mesh.geometry.sets.size());  // for Draco streams, each of which reads them
    for (const TrianglePrimitive& primitive : mesh.geometry.primitives)
      if (is_draco(json_of(mesh, primitive), mesh.geometry.sets[primitive.set])) needs_elements[primitive.set] = true;
    for (const TrianglePrimitive& primitive : mesh.geometry.primitives) {
      if (encoding_.poll) encoding_.poll();
      Json& json = json_of(mesh, primitive);
      VertexSet& set = mesh.geometry.sets[primitive.set];
      if (is_draco(json, set)) {
        write_draco_primitive(json, set, primitive, mesh.box);
      } else {
        const bool meshopt = is_meshopt(json, set);
        if (attributes[primitive.set].is_null())
          std::tie(attributes[primitive.set], targets[primitive.set]) =
              put_vertices(json, set, meshopt, needs_elements[primitive.set]);
        write_plain(json, set, primitive, meshopt, attributes[primitive.set], targets[primitive.set]);
      }
      json.erase("mode");
      erase_extension(json, detail_extension);  // residuals of the old triangles
    }
  }

  BufferPieces finish() {
    if (encoding_.compression == Compression::none) slots_.decompress_rest();
    BufferPieces pieces = slots_.finish();
    list_extensions(document_.json);
    return pieces;
  }

 private:
  Json& json_of(const NewGeometry& mesh, const TrianglePrimitive& primitive) {
    return document_.json["meshes"][mesh.mesh]["primitives"][primitive.number];
  }

  [[nodiscard]] bool is_draco(const Json& primitive, const VertexSet& set) const {
    return becomes_draco(primitive, set, encoding_.compression);
  }

  /// Whether EXT_meshopt_compression compresses a primitive that Draco does not.
  [[nodiscard]] bool is_meshopt(const Json& primitive, const VertexSet& set) const {
    if (encoding_.compression != Compression::same) return encoding_.compression == Compression::meshopt;
    if (find_extension(primitive, draco_extension, "a primitive") != nullptr) return false;
    return slots_.is_compressed(set.find("POSITION")->accessor.value());
  }

  /// Writes the vertices of a set, and takes its elements unless it `keeps` them. Returns the attributes and the morph
  /// targets of its primitives.
  std::pair<Json, Json> put_vertices(const Json& primitive, VertexSet& set, bool meshopt, bool keeps) {
    Json attributes = primitive["attributes"];
    Json targets = primitive.value("targets", Json());
    const auto put = [&](VertexStream& stream) {
      return slots_.put(stream.accessor, keeps ? stream.elements : std::move(stream.elements), Use::vertices, meshopt);
    };
    for (VertexStream& stream : set.attributes) attributes[stream.semantic] = put(stream);
    for (size_t t = 0; t < set.targets.size(); ++t)
      for (VertexStream& stream : set.targets[t]) targets[t][stream.semantic] = put(stream);
    return {std::move(attributes), std::move(targets)};
  }

  /// Writes a primitive without Draco, whose vertices are written.
  void write_plain(Json& json, const VertexSet& set, const TrianglePrimitive& primitive, bool meshopt,
                   const Json& attributes, const Json& targets) {
    put_indices(json, index_elements(primitive.triangles, set.count), meshopt);
    json["attributes"] = attributes;
    if (!targets.is_null()) json["targets"] = targets;
    erase_extension(json, draco_extension);
  }

  void put_indices(Json& json, Elements indices, bool meshopt) {
    const auto old = index_member(json, "indices", "a primitive");
    json["indices"] = slots_.put(old, std::move(indices), Use::indices, meshopt);
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

BufferPieces remove_detail(Document& document) {
  require_sound_views(document);
  const std::vector<uint32_t> views = find_detail_views(document.json);
  for (Json& mesh : document.json["meshes"])
    for (Json& primitive : mesh["primitives"]) erase_extension(primitive, detail_extension);
  list_extensions(document.json);
  return replace_contents(document, {}, views);
}

}  // namespace papilio::proto::gltf
