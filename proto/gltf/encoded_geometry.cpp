#include "proto/gltf/encoded_geometry.h"

#include <cstring>
#include <utility>

#include "proto/gltf/extensions.h"

namespace papilio::proto::gltf {
namespace {

constexpr uint32_t vertex_alignment = 4;

/// Returns elements at `stride`, a multiple of four bytes.
std::string strided(Elements elements, uint32_t stride) {
  const uint32_t size = elements.format.bytes();
  if (stride == size) return std::move(elements.bytes);
  std::string out(elements.count * stride, '\0');
  for (uint64_t i = 0; i < elements.count; ++i) std::memcpy(&out[i * stride], &elements.bytes[i * size], size);
  return out;
}

/// Returns the extension of a compressed view; null for others.
const Json* find_meshopt(const Json& view) { return find_extension(view, meshopt_extension, "a view"); }

class GeometryEncoder {
 public:
  GeometryEncoder(const Document& document, const GeometryEncoding& encoding)
      : json_(document.json), encoding_(encoding), keeps_uncompressed_(document.has_uncompressed_views) {}

  EncodedGeometry run(NewGeometry mesh) {
    EncodedGeometry out{.mesh = mesh.mesh, .sets = {}, .primitives = {}};
    for (const TrianglePrimitive& primitive : mesh.geometry.primitives)
      out.primitives.push_back({.number = primitive.number, .set = primitive.set, .draco = {}, .indices = {}});
    for (uint32_t s = 0; s < mesh.geometry.sets.size(); ++s) out.sets.push_back(encode_set(mesh, s, out.primitives));
    return out;
  }

 private:
  [[nodiscard]] const Json& json_of(const NewGeometry& mesh, const TrianglePrimitive& primitive) const {
    return json_["meshes"][mesh.mesh]["primitives"][primitive.number];
  }

  /// Encodes the primitives of a set, Draco primitives first, as they need its elements. Returns its vertices for the
  /// others.
  EncodedSet encode_set(NewGeometry& mesh, uint32_t number, std::vector<EncodedPrimitive>& out) {
    VertexSet set = std::move(mesh.geometry.sets[number]);
    std::vector<size_t> draco, plain;  // indices of primitives
    for (size_t p = 0; p < mesh.geometry.primitives.size(); ++p)
      if (const TrianglePrimitive& primitive = mesh.geometry.primitives[p]; primitive.set == number)
        (becomes_draco(json_of(mesh, primitive), set, encoding_.compression) ? draco : plain).push_back(p);
    for (size_t i = 0; i < draco.size(); ++i) {
      const bool is_last = i + 1 == draco.size() && plain.empty();
      encode_draco(mesh, mesh.geometry.primitives[draco[i]], is_last ? std::exchange(set, {}) : set, out[draco[i]]);
    }
    if (plain.empty()) return {};
    const bool meshopt = is_meshopt(json_of(mesh, mesh.geometry.primitives[plain[0]]), set);
    for (const size_t p : plain) {
      if (encoding_.poll) encoding_.poll();
      TrianglePrimitive& primitive = mesh.geometry.primitives[p];
      const auto old = index_member(json_of(mesh, primitive), "indices", "a primitive");
      Elements indices = index_elements(std::exchange(primitive.triangles, Buffer<Triangle>()), set.count);
      out[p].indices = encode(old, std::move(indices), false, is_meshopt(json_of(mesh, primitive), set));
    }
    return encode_vertices(std::move(set), meshopt);
  }

  void encode_draco(const NewGeometry& mesh, TrianglePrimitive& primitive, VertexSet set, EncodedPrimitive& out) const {
    if (encoding_.poll) encoding_.poll();
    const auto indices = index_member(json_of(mesh, primitive), "indices", "a primitive");
    out.draco = encode_draco_primitive(json_, std::move(set), std::exchange(primitive.triangles, Buffer<Triangle>()),
                                       indices, mesh.box, encoding_.draco, encoding_.poll);
  }

  /// Returns whether EXT_meshopt_compression compresses a primitive that Draco does not.
  [[nodiscard]] bool is_meshopt(const Json& primitive, const VertexSet& set) const {
    if (encoding_.compression != Compression::same) return encoding_.compression == Compression::meshopt;
    if (find_extension(primitive, draco_extension, "a primitive") != nullptr) return false;
    const uint32_t accessor = set.find("POSITION")->accessor.value();
    const auto view = index_member(element_of(json_, "accessors", accessor, "a primitive"), "bufferView",
                                   place("accessors", accessor));
    const Json& views = array_of(json_, "bufferViews");
    return view && *view < views.size() && find_meshopt(views[*view]) != nullptr;
  }

  [[nodiscard]] EncodedSet encode_vertices(VertexSet set, bool meshopt) const {
    EncodedSet out;
    out.attributes = encode_streams(std::move(set.attributes), meshopt);
    for (auto& target : set.targets) out.targets.push_back(encode_streams(std::move(target), meshopt));
    return out;
  }

  [[nodiscard]] std::vector<EncodedStream> encode_streams(std::vector<VertexStream> streams, bool meshopt) const {
    std::vector<EncodedStream> out;
    out.reserve(streams.size());
    for (VertexStream& stream : streams)
      out.push_back({std::move(stream.semantic), encode(stream.accessor, std::move(stream.elements), true, meshopt)});
    return out;
  }

  [[nodiscard]] EncodedElements encode(std::optional<uint32_t> old, Elements elements, bool are_vertices,
                                       bool meshopt) const {
    EncodedElements out{.summary = summarize(json_, old, elements), .content = {}};
    ViewContent& content = out.content;
    const uint32_t size = elements.format.bytes();
    content.stride = are_vertices ? (size + vertex_alignment - 1) / vertex_alignment * vertex_alignment : size;
    content.strided = are_vertices;
    content.compressed = meshopt && elements.count > 0;
    content.mode = are_vertices ? MeshoptMode::attributes : MeshoptMode::triangles;
    content.bytes = strided(std::move(elements), content.stride);
    if (content.compressed) {
      content.encoded = encode_meshopt(content);
      if (!keeps_uncompressed_) content.left_out = std::exchange(content.bytes, std::string()).size();
    }
    return out;
  }

  const Json& json_;
  const GeometryEncoding& encoding_;
  bool keeps_uncompressed_;
};

uint64_t bytes_of(const ViewContent& content) { return content.bytes.size() + content.encoded.size(); }

uint64_t bytes_of(const std::vector<EncodedStream>& streams) {
  uint64_t bytes = 0;
  for (const EncodedStream& stream : streams) bytes += bytes_of(stream.elements.content);
  return bytes;
}

}  // namespace

uint64_t EncodedGeometry::bytes() const {
  uint64_t bytes = 0;
  for (const EncodedSet& set : sets) {
    bytes += bytes_of(set.attributes);
    for (const auto& target : set.targets) bytes += bytes_of(target);
  }
  for (const EncodedPrimitive& primitive : primitives)
    bytes += bytes_of(primitive.indices.content) + (primitive.draco ? primitive.draco->stream.size() : 0);
  return bytes;
}

EncodedGeometry encode_geometry(const Document& document, NewGeometry mesh, const GeometryEncoding& encoding) {
  return GeometryEncoder(document, encoding).run(std::move(mesh));
}

}  // namespace papilio::proto::gltf
