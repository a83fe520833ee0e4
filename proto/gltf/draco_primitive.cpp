#include "proto/gltf/draco_primitive.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "proto/draco_reader.h"
#include "proto/encoding_memory.h"
#include "proto/error_translation.h"
#include "proto/gltf/extensions.h"
#include "proto/gltf/vertices.h"
#include "proto/problem.h"
#include "proto/text.h"

namespace papilio::proto::gltf {
namespace {

constexpr std::array<std::pair<ComponentType, ValueType>, 6> stored_types{
    {{ComponentType::int8, ValueType::int8},
     {ComponentType::uint8, ValueType::uint8},
     {ComponentType::int16, ValueType::int16},
     {ComponentType::uint16, ValueType::uint16},
     {ComponentType::uint32, ValueType::uint32},
     {ComponentType::float32, ValueType::float32}}};

AttributeKind kind_of(const std::string& semantic) {
  if (semantic == "NORMAL") return AttributeKind::normal;
  if (semantic.starts_with("COLOR_")) return AttributeKind::color;
  return semantic.starts_with("TEXCOORD_") ? AttributeKind::tex_coord : AttributeKind::generic;
}

Elements elements_of(const ElementFormat& format, const std::vector<double>& values) {
  Elements out = zero_elements(format, values.size() / format.components);
  for (size_t i = 0; i < values.size(); ++i) out.set_number(i / format.components, i % format.components, values[i]);
  return out;
}

Elements position_elements(const FormattedMesh& mesh) {
  Elements out = zero_elements({ComponentType::float32, 3, false}, mesh.positions.size());
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    out.set_number(i, 0, mesh.positions[i].x);
    out.set_number(i, 1, mesh.positions[i].y);
    out.set_number(i, 2, mesh.positions[i].z);
  }
  return out;
}

/// Returns the attribute of Draco's unique id as elements of `format`; nothing if there is none that fits.
std::optional<Elements> find_elements(const FormattedMesh& mesh, uint64_t id, const ElementFormat& format) {
  if (id == mesh.format.position_id) {
    if (format.components != 3 || format.type != ComponentType::float32) return std::nullopt;
    return position_elements(mesh);
  }
  const auto found = std::ranges::find(mesh.format.attributes, id, &AttributeFormat::id);
  if (found == mesh.format.attributes.end()) return std::nullopt;
  const Attribute& attribute = mesh.attributes[static_cast<size_t>(found - mesh.format.attributes.begin())];
  if (attribute.components != format.components) return std::nullopt;
  return elements_of(format, attribute.values);
}

/// An attribute without values, and its format.
std::pair<Attribute, AttributeFormat> attribute_of(const VertexStream& stream, uint32_t id) {
  const ElementFormat& format = stream.elements.format;
  const auto* type = std::ranges::find(stored_types, format.type, &std::pair<ComponentType, ValueType>::first);
  std::pair<Attribute, AttributeFormat> made;
  made.first.components = format.components;
  made.second = {.kind = kind_of(stream.semantic), .type = type->second, .normalized = format.normalized, .id = id};
  return made;
}

/// Returns the vertices and triangles of a primitive as the core takes them, and their format.
FormattedMesh formatted(const VertexSet& set, const Buffer<Triangle>& triangles,
                        std::vector<std::pair<std::string, uint32_t>>& ids) {
  FormattedMesh mesh;
  mesh.positions = vertex_positions(set);
  mesh.triangles.assign(triangles.begin(), triangles.end());
  ids.emplace_back("POSITION", 0);
  for (const VertexStream& stream : set.attributes) {
    if (stream.semantic == "POSITION") continue;
    const auto id = static_cast<uint32_t>(ids.size());
    ids.emplace_back(stream.semantic, id);
    auto [attribute, format] = attribute_of(stream, id);
    attribute.values.resize(set.count * attribute.components);
    for (size_t i = 0; i < attribute.values.size(); ++i)
      attribute.values[i] = stream.elements.number(i / attribute.components, i % attribute.components);
    mesh.attributes.push_back(std::move(attribute));
    mesh.format.attributes.push_back(std::move(format));
  }
  return mesh;
}

/// Returns the stream of a primitive, and in `ids` its attributes.
std::string compress(const VertexSet& set, const Buffer<Triangle>& triangles, const QuantizationBox& box,
                     const OutputOptions& options, const std::function<void()>& poll,
                     std::vector<std::pair<std::string, uint32_t>>& ids) {
  MeshFormat format;
  const Mesh mesh = [&] {
    FormattedMesh input = formatted(set, triangles, ids);
    format = std::move(input.format);
    return translate_errors([&] { return build_mesh(input); });
  }();
  AttributeEncoding encoding = attribute_encoding(mesh, std::move(format));
  for (size_t a = 0; a < encoding.grids.size(); ++a)  // weights on a grid would not add up to 1
    if (ids[a + 1].first.starts_with("WEIGHTS_")) encoding.grids[a].range = 0;
  return write_draco(mesh, box, options, encoding, poll);
}

}  // namespace

DracoPrimitive read_draco_primitive(Views& views, const Json& extension, const Json& attributes, const Limits& limits,
                                    const std::string& where) {
  const auto view = index_member(extension, "bufferView", where);
  const Json* ids = find_member(extension, "attributes", where);
  if (!view || ids == nullptr || !ids->is_object()) refuse_document(where, "has a Draco extension without its members");
  const FormattedMesh mesh = read_draco(views.bytes(*view, where), limits);
  DracoPrimitive out;
  out.count = mesh.positions.size();
  out.triangles.assign(mesh.triangles.begin(), mesh.triangles.end());
  for (const auto& [semantic, value] : ids->items()) {
    (void)value;
    const std::string name = where + "." + shorten(semantic);
    const auto accessor = index_member(attributes, semantic.c_str(), where);
    if (!accessor) refuse_document(name, "is in the Draco stream, but no attribute of the primitive");
    const Json& json = element_of(views.document().json, "accessors", *accessor, name);
    const ElementFormat format = element_format(json, place("accessors", *accessor));
    if (whole_number(json, "count", place("accessors", *accessor)) != out.count)
      refuse_document(name, "declares other than the " + std::to_string(out.count) + " vertices of its Draco stream");
    views.require_room(out.count * format.bytes());
    auto elements = find_elements(mesh, whole_number(*ids, semantic.c_str(), where), format);
    if (!elements) refuse_document(name, "is not in its Draco stream, or of another format there");
    out.attributes.push_back({semantic, *accessor, std::move(*elements)});
  }
  return out;
}

EncodedPrimitive encode_draco_primitive(const VertexSet& set, const Buffer<Triangle>& triangles,
                                        const QuantizationBox& box, const OutputOptions& options,
                                        const std::function<void()>& poll) {
  EncodedPrimitive made;
  made.stream = compress(set, triangles, box, options, poll, made.ids);
  const Limits no_limits{.max_input_faces = face_count_limit,
                         .max_input_vertices = face_count_limit,
                         .max_output_faces = face_count_limit};
  const FormattedMesh decoded = read_draco(made.stream, no_limits);
  made.decoded.count = decoded.positions.size();
  made.decoded.triangles.assign(decoded.triangles.begin(), decoded.triangles.end());
  for (const auto& [semantic, id] : made.ids) {
    ElementFormat format = set.find(semantic)->elements.format;
    if (semantic == "POSITION") format = {ComponentType::float32, 3, false};
    made.decoded.attributes.push_back({semantic, set.find(semantic)->accessor, *find_elements(decoded, id, format)});
  }
  return made;
}

bool becomes_draco(const Json& primitive, const VertexSet& set, Compression requested) {
  if (!set.targets.empty()) return false;
  if (requested != Compression::same) return requested == Compression::draco;
  return find_extension(primitive, draco_extension, "a primitive") != nullptr;
}

OutputBytes draco_bytes(const VertexSet& set) {
  std::vector<Attribute> attributes;
  MeshFormat format;
  for (const VertexStream& stream : set.attributes) {
    if (stream.semantic == "POSITION") continue;
    auto [attribute, described] = attribute_of(stream, 0);
    attributes.push_back(std::move(attribute));
    format.attributes.push_back(std::move(described));
  }
  OutputBytes bytes = encoding_bytes(attributes, false, format);
  bytes.face += sizeof(Triangle);
  bytes.point += bytes_of_vertex(set);
  for (const Attribute& attribute : attributes) bytes.point += attribute.components * sizeof(double);
  return bytes;
}

}  // namespace papilio::proto::gltf
