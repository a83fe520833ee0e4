#include "proto/gltf/geometry.h"

#include <algorithm>
#include <map>

#include "proto/draco_header.h"
#include "proto/gltf/draco_primitive.h"
#include "proto/gltf/extensions.h"
#include "proto/problem.h"
#include "proto/text.h"

namespace papilio::proto::gltf {
namespace {

constexpr size_t most_streams = 1024;  // upper bound of the attributes of a primitive

void spend(uint64_t& left, uint64_t count, const char* what) {
  require_within(count, left, what, "The limit holds for the whole scene. Use a coarser scene.");
  left -= count;
}

const Json& attributes_of(const Json& primitive, const std::string& where) {
  const Json* attributes = find_member(primitive, "attributes", where);
  if (attributes == nullptr || !attributes->is_object()) refuse_document(where, "has no attributes");
  if (attributes->size() > most_streams)
    refuse_document(where, "has " + std::to_string(attributes->size()) + " attributes; at most 1024 are allowed");
  return *attributes;
}

std::vector<VertexStream> read_streams(Views& views, const Json& attributes, uint64_t count, const std::string& where) {
  std::vector<VertexStream> streams;
  for (const auto& [semantic, value] : attributes.items()) {
    (void)value;
    const std::string name = where + "." + shorten(semantic);
    const auto accessor = *index_member(attributes, semantic.c_str(), where);
    streams.push_back({semantic, accessor, read_accessor(views, accessor, count, name)});
    if (streams.back().elements.count != count)
      refuse_document(name, "has " + std::to_string(streams.back().elements.count) + " elements, and there are " +
                                std::to_string(count) + " positions");
  }
  return streams;
}

uint64_t declared_count(const Document& document, const Json& attributes, const std::string& where) {
  const auto accessor = index_member(attributes, "POSITION", where);
  if (!accessor) refuse_document(where, "has no POSITION");
  return whole_number(element_of(document.json, "accessors", *accessor, where), "count", place("accessors", *accessor));
}

void require_positions(const VertexSet& set, const std::string& where) {
  const VertexStream* positions = set.find("POSITION");
  if (positions->elements.format.components != 3) refuse_document(where + ".POSITION", "is no VEC3");
}

void read_targets(Views& views, const Json& primitive, VertexSet& set, const std::string& where) {
  const Json* targets = find_member(primitive, "targets", where);
  if (targets == nullptr) return;
  if (!targets->is_array() || targets->size() > most_streams)
    refuse_document(where + ".targets", "must be an array of at most 1024 targets");
  for (size_t i = 0; i < targets->size(); ++i) {
    const std::string name = where + ".targets[" + std::to_string(i) + "]";
    if (!(*targets)[i].is_object()) refuse_document(name, "must be an object");
    set.targets.push_back(read_streams(views, (*targets)[i], set.count, name));
  }
}

std::vector<uint32_t> read_indices(Views& views, const Json& primitive, uint64_t vertex_count, uint64_t limit,
                                   const std::string& where) {
  std::vector<uint32_t> indices;
  const auto accessor = index_member(primitive, "indices", where);
  if (!accessor) {
    indices.resize(vertex_count);
    for (uint32_t i = 0; i < indices.size(); ++i) indices[i] = i;
    return indices;
  }
  const Elements elements = read_accessor(views, *accessor, limit, where + ".indices");
  if (elements.format.components != 1 || is_signed(elements.format.type))
    refuse_document(where + ".indices", "must be unsigned scalars");
  indices.resize(elements.count);
  for (uint64_t i = 0; i < elements.count; ++i) {
    indices[i] = static_cast<uint32_t>(elements.number(i, 0));
    if (indices[i] >= vertex_count)
      throw Problem(Code::mesh_unusable, where + " has the index " + std::to_string(indices[i]) + " at " +
                                             std::to_string(i) + ", and there are " + std::to_string(vertex_count) +
                                             " vertices. Export the scene again.");
  }
  return indices;
}

/// Returns the triangles of a list, strip or fan: glTF 2.0, section 3.7.2.1.
Buffer<Triangle> triangles_of_indices(const std::vector<uint32_t>& indices, PrimitiveMode mode) {
  Buffer<Triangle> triangles;
  if (mode == PrimitiveMode::triangles) {
    for (size_t i = 0; i + 2 < indices.size(); i += 3)
      triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    return triangles;
  }
  for (size_t i = 0; i + 2 < indices.size(); ++i) {
    if (mode == PrimitiveMode::fan)
      triangles.push_back({indices[i + 1], indices[i + 2], indices[0]});
    else
      triangles.push_back({indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
  }
  return triangles;
}

/// Returns a key: primitives with equal keys share their vertices.
std::string key_of(const Json& primitive) {
  Json key{primitive["attributes"], primitive.value("targets", Json())};
  if (primitive.contains("extensions")) key.push_back(primitive["extensions"].value(draco_extension, Json()));
  return key.dump();
}

class GeometryReader {
 public:
  GeometryReader(Views& views, Allowance& allowance) : views_(views), allowance_(allowance) {}

  void read(const Json& primitive, uint32_t number, const std::string& where) {
    const auto mode = triangle_mode(primitive, where);
    if (!mode || !attributes_of(primitive, where).contains("POSITION")) return;
    if (const Json* draco = find_extension(primitive, draco_extension, where)) {
      read_compressed(primitive, *draco, number, where);
      return;
    }
    const uint32_t set = set_of(primitive, where);
    const uint64_t most_indices = 3 * allowance_.faces + 2;
    const auto indices = read_indices(views_, primitive, out_.sets[set].count, most_indices, where);
    out_.primitives.push_back({number, set, triangles_of_indices(indices, *mode)});
    spend(allowance_.faces, out_.primitives.back().triangles.size(), "faces");
  }

  MeshGeometry finish() { return std::move(out_); }

 private:
  uint32_t set_of(const Json& primitive, const std::string& where) {
    const auto [known, is_new] = sets_.emplace(key_of(primitive), static_cast<uint32_t>(out_.sets.size()));
    if (!is_new) return known->second;
    const Json& attributes = attributes_of(primitive, where);
    VertexSet set;
    set.count = declared_count(views_.document(), attributes, where);
    spend(allowance_.points, set.count, "points");
    set.attributes = read_streams(views_, attributes, set.count, where + ".attributes");
    require_positions(set, where);
    read_targets(views_, primitive, set, where);
    out_.sets.push_back(std::move(set));
    return known->second;
  }

  void read_compressed(const Json& primitive, const Json& draco, uint32_t number, const std::string& where) {
    const Limits left{.max_input_faces = allowance_.faces, .max_input_vertices = allowance_.points};
    DracoPrimitive decoded = read_draco_primitive(views_, draco, attributes_of(primitive, where), left, where);
    spend(allowance_.faces, decoded.triangles.size(), "faces");
    spend(allowance_.points, decoded.count, "points");
    VertexSet set;
    set.count = decoded.count;
    Json others = Json::object();
    for (const auto& [semantic, accessor] : attributes_of(primitive, where).items()) {
      const auto found = std::ranges::find(decoded.attributes, semantic, &VertexStream::semantic);
      if (found == decoded.attributes.end()) others[semantic] = accessor;
    }
    set.attributes = std::move(decoded.attributes);
    for (VertexStream& stream : read_streams(views_, others, set.count, where + ".attributes"))
      set.attributes.push_back(std::move(stream));
    require_positions(set, where);
    read_targets(views_, primitive, set, where);
    out_.primitives.push_back({number, static_cast<uint32_t>(out_.sets.size()), std::move(decoded.triangles)});
    out_.sets.push_back(std::move(set));
  }

  Views& views_;
  Allowance& allowance_;
  MeshGeometry out_;
  std::map<std::string, uint32_t> sets_;
};

}  // namespace

const VertexStream* VertexSet::find(const std::string& semantic) const {
  const auto found = std::ranges::find(attributes, semantic, &VertexStream::semantic);
  return found == attributes.end() ? nullptr : &*found;
}

const Elements* find_vectors(const std::vector<VertexStream>& streams, std::string_view semantic) {
  const auto found = std::ranges::find(streams, semantic, &VertexStream::semantic);
  return found != streams.end() && found->elements.format.components == 3 ? &found->elements : nullptr;
}

uint64_t bytes_of_vertex(const VertexSet& set) {
  uint64_t bytes = 0;
  for (const VertexStream& stream : set.attributes) bytes += stream.elements.format.bytes();
  for (const auto& target : set.targets)
    for (const VertexStream& stream : target) bytes += stream.elements.format.bytes();
  return bytes;
}

std::optional<PrimitiveMode> triangle_mode(const Json& primitive, const std::string& where) {
  const uint64_t mode = whole_number(primitive, "mode", where, static_cast<uint64_t>(PrimitiveMode::triangles));
  if (mode > static_cast<uint64_t>(PrimitiveMode::fan))
    refuse_document(where, "has the unknown mode " + std::to_string(mode));
  if (mode < static_cast<uint64_t>(PrimitiveMode::triangles)) return std::nullopt;
  return static_cast<PrimitiveMode>(mode);
}

MeshGeometry read_geometry(Views& views, uint32_t mesh, Allowance& allowance) {
  const std::string where = place("meshes", mesh);
  const Json* primitives = find_member(element_of(views.document().json, "meshes", mesh, where), "primitives", where);
  if (primitives == nullptr || !primitives->is_array()) refuse_document(where, "has no primitives");
  GeometryReader reader(views, allowance);
  for (size_t i = 0; i < primitives->size(); ++i)
    reader.read((*primitives)[i], static_cast<uint32_t>(i), where + ".primitives[" + std::to_string(i) + "]");
  return reader.finish();
}

}  // namespace papilio::proto::gltf
