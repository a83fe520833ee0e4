#include "proto/gltf/draco_primitive.h"

#include <algorithm>
#include <array>
#include <utility>

#include "proto/draco_reader.h"
#include "proto/edgebreaker/decoded_bounds.h"
#include "proto/edgebreaker/writer.h"
#include "proto/encoding_memory.h"
#include "proto/error_translation.h"
#include "proto/freed_memory.h"
#include "proto/gltf/extensions.h"
#include "proto/gltf/pointed_mesh.h"
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

Elements position_elements(const Buffer<Vec3f>& positions) {
  Elements out = zero_elements({ComponentType::float32, 3, false}, positions.size());
  for (size_t i = 0; i < positions.size(); ++i) {
    out.set_number(i, 0, positions[i].x);
    out.set_number(i, 1, positions[i].y);
    out.set_number(i, 2, positions[i].z);
  }
  return out;
}

/// Returns the attribute with a unique id of Draco as elements of `format`; nothing if there is none of that format.
std::optional<Elements> find_elements(const FormattedMesh& mesh, uint64_t id, const ElementFormat& format) {
  if (id == mesh.format.position_id) {
    if (format.components != 3 || format.type != ComponentType::float32) return std::nullopt;
    return position_elements(mesh.positions);
  }
  const auto found = std::ranges::find(mesh.format.attributes, id, &AttributeFormat::id);
  if (found == mesh.format.attributes.end()) return std::nullopt;
  const Attribute& attribute = mesh.attributes[static_cast<size_t>(found - mesh.format.attributes.begin())];
  if (attribute.components != format.components) return std::nullopt;
  return elements_of(format, attribute.values);
}

/// Returns an attribute without values, and its format.
std::pair<Attribute, AttributeFormat> attribute_of(const VertexStream& stream, uint32_t id) {
  const ElementFormat& format = stream.elements.format;
  const auto* type = std::ranges::find(stored_types, format.type, &std::pair<ComponentType, ValueType>::first);
  std::pair<Attribute, AttributeFormat> made;
  made.first.components = format.components;
  made.second = {.kind = kind_of(stream.semantic), .type = type->second, .normalized = format.normalized, .id = id};
  return made;
}

/// Returns whether quantization would damage an attribute: the sum of weights, or IDs.
bool needs_exact_numbers(const std::string& semantic) {
  return semantic.starts_with("WEIGHTS_") || semantic.starts_with("_FEATURE_ID_");
}

/// Returns whether the arrays of a primitive are large enough to return memory to the system.
bool is_worth_giving_back(const VertexSet& set, const Buffer<Triangle>& triangles) {
  return set.count * bytes_of_vertex(set) + triangles.size() * sizeof(Triangle) >= worth_giving_back;
}

/// Returns the bounds of an attribute's decoded numbers in the form of an accessor of `type`.
std::pair<Json, Json> declared_bounds(const OutputAttribute& attribute, ComponentType type) {
  const edgebreaker::NumberBounds bounds = edgebreaker::decoded_bounds(attribute);
  return {declared_bound(type, bounds.low), declared_bound(type, bounds.high)};
}

/// Compresses a primitive. Describes its attributes in `made`, except for the number of points and the bounds of
/// positions, which follow from the stream. Consumes the bytes of the set's elements.
edgebreaker::WrittenStream compress(const Json& document, VertexSet& set, Buffer<Triangle> triangles,
                                    const QuantizationBox& box, const OutputOptions& options,
                                    const std::function<void()>& poll, DracoContent& made) {
  const bool is_large = is_worth_giving_back(set, triangles);
  if (is_large) give_back_freed();  // the mesh takes the place of spare blocks
  PointedMesh pointed = translate_errors([&] { return build_pointed_mesh(set, std::move(triangles)); });
  if (is_large) give_back_freed();
  std::vector<OutputAttribute> attributes;
  std::optional<VertexPoints> points;
  made.ids.emplace_back("POSITION", 0);
  made.attributes.emplace_back("POSITION", ElementSummary{.accessor = set.find("POSITION")->accessor,
                                                          .format = {ComponentType::float32, 3, false}});
  for (VertexStream& stream : set.attributes) {
    if (stream.semantic == "POSITION") continue;
    const auto id = static_cast<uint32_t>(made.ids.size());
    made.ids.emplace_back(stream.semantic, id);
    auto [attribute, format] = attribute_of(stream, id);
    attribute.values = pointed.values_of(stream.elements);
    std::string().swap(stream.elements.bytes);
    AttributeEncoding::Grid grid = grid_of(attribute);
    if (needs_exact_numbers(stream.semantic)) grid.range = 0;
    if (!points) points.emplace(pointed.mesh);
    attributes.push_back(output_attribute(attribute, format, grid, *points));
    ElementSummary summary{.accessor = stream.accessor, .format = stream.elements.format};
    if (declares_bounds(document, stream.accessor))
      summary.bounds = declared_bounds(attributes.back(), summary.format.type);
    made.attributes.emplace_back(stream.semantic, std::move(summary));
  }
  points.reset();
  if (is_large) give_back_freed();
  edgebreaker::WrittenStream written =
      edgebreaker::write_and_free(std::move(pointed.mesh), box, options, 0, std::move(attributes), poll);
  if (is_large) give_back_freed();
  return written;
}

Json json_of(Vec3f v) {
  return Json::array({static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)});
}

/// Completes the description from the written stream.
void describe(const Json& document, std::optional<uint32_t> indices, const edgebreaker::WrittenStream& written,
              DracoContent& made) {
  for (auto& [semantic, summary] : made.attributes) summary.count = written.points;
  ElementSummary& positions = made.attributes.front().second;
  if (declares_bounds(document, positions.accessor))
    positions.bounds.emplace(json_of(written.box.min), json_of(written.box.max));
  made.indices = {
      .accessor = indices, .format = index_elements({}, written.points).format, .count = uint64_t{3} * written.faces};
  if (declares_bounds(document, indices))
    made.indices.bounds.emplace(Json::array({0}), Json::array({written.points - 1}));
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

DracoContent encode_draco_primitive(const Json& document, VertexSet set, Buffer<Triangle> triangles,
                                    std::optional<uint32_t> indices, const QuantizationBox& box,
                                    const OutputOptions& options, const std::function<void()>& poll) {
  DracoContent made;
  edgebreaker::WrittenStream written = compress(document, set, std::move(triangles), box, options, poll, made);
  made.stream = std::move(written.bytes);
  describe(document, indices, written, made);
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
    described.kind = AttributeKind::generic;  // no normals are added here
    attributes.push_back(std::move(attribute));
    format.attributes.push_back(std::move(described));
  }
  OutputBytes bytes = encoding_bytes(attributes, false, format);
  // Bytes of the refined mesh, which is freed by then: half-edges, and the place and origin of each point.
  constexpr uint64_t freed_face_bytes = 3 * 3 * sizeof(uint32_t);
  constexpr uint64_t freed_point_bytes = sizeof(Vec3f) + 3 * sizeof(double);
  bytes.face += sizeof(Triangle) - freed_face_bytes;
  bytes.point -= std::min(bytes.point, freed_point_bytes);
  return bytes;
}

}  // namespace papilio::proto::gltf
