#include "proto/gltf/flattening.h"

#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>

#include "proto/draco_header.h"
#include "proto/gltf/document_writer.h"
#include "proto/gltf/material_reader.h"
#include "proto/gltf/material_writer.h"
#include "proto/gltf/scene_mesh.h"
#include "proto/gltf/vertices.h"
#include "proto/problem.h"

namespace papilio::proto::gltf {
namespace {

/// Attribute that a flat mesh keeps.
struct FlatAttribute {
  const char* semantic;
  AttributeKind kind;
  uint32_t components;
};
constexpr std::array flat_attributes{FlatAttribute{"NORMAL", AttributeKind::normal, 3},
                                     FlatAttribute{"TEXCOORD_0", AttributeKind::tex_coord, 2},
                                     FlatAttribute{"COLOR_0", AttributeKind::color, 4},
                                     FlatAttribute{smoothing_group_semantic, AttributeKind::generic, 1}};

bool is_mirrored(const Affine& map) { return dot(cross(map.axes[0], map.axes[1]), map.axes[2]) < 0; }

/// Returns a triangle with the orientation that it has after `map`: mirroring maps reverse it.
Triangle wound(Triangle triangle, const Affine& map) {
  if (is_mirrored(map)) std::swap(triangle[1], triangle[2]);
  return triangle;
}

/// Returns the direction of a normal on the moved surface.
Vec3d moved_normal(const Affine& map, Vec3d normal) {
  const auto& [x, y, z] = map.axes;
  Vec3d moved = normal.x * cross(y, z) + normal.y * cross(z, x) + normal.z * cross(x, y);
  if (is_mirrored(map)) moved = -1.0 * moved;
  const double size = length(moved);
  return size > 0 ? 1 / size * moved : normal;
}

/// Returns an attribute of a set; null if it has none.
const VertexStream* find_stream(const VertexSet& set, const FlatAttribute& attribute, const TextureMap& map) {
  if (attribute.kind != AttributeKind::tex_coord || map.set == 0) return set.find(attribute.semantic);
  return set.find("TEXCOORD_" + std::to_string(map.set));
}

/// Set of vertices, and its placement by a node.
struct PlacedSet {
  const VertexSet& set;
  Buffer<Vec3f> positions;
  const Affine& map;

  [[nodiscard]] Vec3d point(uint32_t vertex) const { return map.point(to_double(positions[vertex])); }
};

/// Vertices of a set in the result, with the texture coordinates of one map.
struct PlacedVertices {
  TextureMap map;
  bool is_whole = false;  ///< whether all vertices of the set are consecutive from `first`
  uint32_t first = 0;
  std::unordered_map<uint32_t, uint32_t> numbers{};  ///< numbers in the result, unless `is_whole`
};

class Flattener {
 public:
  /// Prepares the attributes. `reader` reads materials; null for none.
  Flattener(const SceneMeshes& scene, MaterialReader* reader) : reader_(reader) {
    for (const FlatAttribute& attribute : flat_attributes)
      for (const SceneMesh& mesh : scene.meshes)
        for (const TrianglePrimitive& primitive : mesh.geometry.primitives)
          if (find_stream(mesh.geometry.sets[primitive.set], attribute, map_of(mesh, primitive)) != nullptr)
            add_attribute(attribute);
  }

  void add(const SceneMesh& mesh, const std::vector<Affine>& maps) {
    for (const VertexSet& set : mesh.geometry.sets) {
      const PlacedSet from{set, vertex_positions(set), maps[0]};
      const auto number = static_cast<uint32_t>(&set - mesh.geometry.sets.data());
      std::vector<PlacedVertices> placed;
      for (const TrianglePrimitive& primitive : mesh.geometry.primitives) {
        if (primitive.set != number) continue;
        const TextureMap map = map_of(mesh, primitive);
        if (lacks_normals(set))
          add_facets(from, primitive.triangles, map);
        else
          add_triangles(primitive.triangles, place_vertices(from, primitive.triangles, map, placed), maps[0]);
        if (reader_ != nullptr) materials_.resize(out_.triangles.size(), material_of(mesh, primitive));
      }
    }
  }

  MaterialMesh finish() {
    MaterialMesh out{std::move(out_)};
    if (reader_ != nullptr) out.materials = reader_->finish();
    if (!out.materials.empty()) out.materials.of_triangle = std::move(materials_);
    return out;
  }

 private:
  [[nodiscard]] uint32_t point_count() const { return static_cast<uint32_t>(out_.positions.size()); }

  uint32_t material_of(const SceneMesh& mesh, const TrianglePrimitive& primitive) {
    return reader_ == nullptr ? none : reader_->material_of(mesh.number, primitive.number);
  }
  TextureMap map_of(const SceneMesh& mesh, const TrianglePrimitive& primitive) {
    return reader_ == nullptr ? TextureMap{} : reader_->map_of(material_of(mesh, primitive));
  }

  /// Returns whether the result has normals, but the set has none.
  [[nodiscard]] bool lacks_normals(const VertexSet& set) const {
    return set.find("NORMAL") == nullptr &&
           std::ranges::find(used_, AttributeKind::normal, &FlatAttribute::kind) != used_.end();
  }

  /// Adds the vertices of triangles that are not yet placed. Returns their places.
  const PlacedVertices& place_vertices(const PlacedSet& from, const Buffer<Triangle>& triangles, const TextureMap& map,
                                       std::vector<PlacedVertices>& placed) {
    auto found = std::ranges::find(placed, map, &PlacedVertices::map);
    if (found == placed.end()) {
      placed.push_back({.map = map, .is_whole = placed.empty(), .first = point_count()});
      found = placed.end() - 1;
      for (uint32_t i = 0; found->is_whole && i < from.set.count; ++i) add_vertex(from, i, map);
    }
    if (!found->is_whole)
      for (const Triangle& triangle : triangles)
        for (const uint32_t v : triangle)
          if (found->numbers.try_emplace(v, point_count()).second) add_vertex(from, v, map);
    return *found;
  }

  /// Adds triangles with their own vertices and the normals of their planes, as glTF prescribes without normals.
  void add_facets(const PlacedSet& from, const Buffer<Triangle>& triangles, const TextureMap& map) {
    for (const Triangle& t : triangles) {
      const auto [a, b, c] = std::array{from.point(t[0]), from.point(t[1]), from.point(t[2])};
      const Vec3d across = cross(b - a, c - a);
      const double size = length(across);
      const Vec3d normal = size > 0 ? (is_mirrored(from.map) ? -1 : 1) / size * across : Vec3d{0, 0, 1};
      const uint32_t first = point_count();
      for (const uint32_t v : t) add_vertex(from, v, map, normal);
      out_.triangles.push_back(wound({first, first + 1, first + 2}, from.map));
    }
  }

  /// Adds a vertex. `normal`: its normal in the result if the set has none.
  void add_vertex(const PlacedSet& from, uint32_t vertex, const TextureMap& texture, Vec3d normal = {}) {
    out_.positions.push_back(to_float(from.point(vertex)));
    for (size_t a = 0; a < used_.size(); ++a) append(a, from, vertex, texture, normal);
  }

  void add_attribute(const FlatAttribute& attribute) {
    if (std::ranges::find(used_, attribute.semantic, &FlatAttribute::semantic) != used_.end()) return;
    used_.push_back(attribute);
    out_.attributes.push_back(
        {.components = attribute.components, .unit_length = attribute.kind == AttributeKind::normal, .values = {}});
    const bool is_color = attribute.kind == AttributeKind::color;
    const bool is_group = attribute.kind == AttributeKind::generic;
    out_.attributes.back().is_smoothing_group = is_group;
    out_.format.attributes.push_back({.kind = attribute.kind,
                                      .type = is_color   ? ValueType::uint8
                                              : is_group ? ValueType::int32
                                                         : ValueType::float32,
                                      .normalized = is_color,
                                      .id = static_cast<uint32_t>(used_.size()),
                                      .name = is_group ? smoothing_group_name : ""});
  }

  void append(size_t number, const PlacedSet& from, uint32_t vertex, const TextureMap& texture, Vec3d normal) {
    const FlatAttribute& attribute = used_[number];
    const VertexStream* stream = find_stream(from.set, attribute, texture);
    std::array<double, 4> value{};
    if (attribute.kind == AttributeKind::generic) value[0] = default_smoothing_group;
    if (attribute.kind == AttributeKind::color) value = {1, 1, 1, 1};  // keeps the material's colour
    if (attribute.kind == AttributeKind::normal) value = {normal.x, normal.y, normal.z, 0};
    const uint32_t given = stream == nullptr ? 0 : std::min(stream->elements.format.components, attribute.components);
    for (uint32_t c = 0; c < given; ++c) value[c] = stream->elements.number(vertex, c) * stream->elements.format.unit();
    if (attribute.kind == AttributeKind::normal && given > 0) {
      const Vec3d moved = moved_normal(from.map, {value[0], value[1], value[2]});
      value = {moved.x, moved.y, moved.z, 0};
    }
    if (attribute.kind == AttributeKind::tex_coord) {
      const auto [u, v] = texture.point(value[0], value[1]);
      value = {u, 1 - v, 0, 0};
    }
    constexpr double color_range = 255;
    std::vector<double>& values = out_.attributes[number].values;
    for (uint32_t c = 0; c < attribute.components; ++c)
      values.push_back(attribute.kind == AttributeKind::color ? std::clamp(value[c], 0.0, 1.0) * color_range
                                                              : value[c]);
  }

  void add_triangles(const Buffer<Triangle>& triangles, const PlacedVertices& placed, const Affine& map) {
    const auto number = [&](uint32_t v) { return placed.is_whole ? placed.first + v : placed.numbers.at(v); };
    for (const Triangle& t : triangles)
      out_.triangles.push_back(wound({number(t[0]), number(t[1]), number(t[2])}, map));
  }

  MaterialReader* reader_;
  std::vector<FlatAttribute> used_;
  FormattedMesh out_;
  std::vector<uint32_t> materials_;  ///< [triangles] material, with a reader
};

/// Returns the semantic of an attribute in glTF. `numbers` counts attributes of each kind.
std::string semantic_of(const AttributeFormat& format, uint32_t components, std::array<int, 4>& numbers) {
  int& number = numbers.at(static_cast<size_t>(format.kind));
  const bool is_float = format.type == ValueType::float32;
  const std::string count = std::to_string(number);
  if (format.kind == AttributeKind::normal && components == 3 && is_float && number++ == 0) return "NORMAL";
  if (format.kind == AttributeKind::tex_coord && components == 2 && is_float) return ++number, "TEXCOORD_" + count;
  if (format.kind == AttributeKind::color && components >= 3) return ++number, "COLOR_" + count;
  if (is_smoothing_group(format, components)) return smoothing_group_semantic;
  int& others = numbers[3];
  return "_ATTRIBUTE_" + std::to_string(others++);
}

/// Builder of a scene, which appends accessors, views and bytes of new elements.
class SceneBuilder {
 public:
  uint32_t add(const Elements& elements, int target, bool has_bounds) {
    Json accessor{
        {"bufferView", views_.size()},
        {"componentType", static_cast<uint32_t>(elements.format.type)},
        {"count", elements.count},
        {"type", elements.format.components == 1 ? "SCALAR" : "VEC" + std::to_string(elements.format.components)}};
    if (elements.format.normalized) accessor["normalized"] = true;
    if (has_bounds) add_bounds(accessor, elements);
    views_[add_view(elements.bytes)]["target"] = target;
    accessors_.push_back(std::move(accessor));
    return static_cast<uint32_t>(accessors_.size() - 1);
  }

  size_t add_view(std::string_view bytes) {
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}});
    bytes_ += bytes;
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    return views_.size() - 1;
  }

  std::string finish(Json primitives, const Materials& materials, bool has_coordinates) {
    Json json{{"asset", {{"version", "2.0"}, {"generator", "papilio"}}}, {"scene", 0}};
    json["scenes"] = Json::array({{{"nodes", {0}}}});
    json["nodes"] = Json::array({{{"mesh", 0}}});
    json["meshes"] = Json::array({{{"primitives", std::move(primitives)}}});
    add_materials(json, materials, has_coordinates, [this](std::string_view bytes) { return add_view(bytes); });
    json["accessors"] = std::move(accessors_);
    json["bufferViews"] = std::move(views_);
    json["buffers"] = Json::array({{{"byteLength", bytes_.size()}}});
    std::vector<Piece> chunk;
    chunk.push_back({{}, std::move(bytes_)});
    return write_glb(json.dump(), std::move(chunk), {});
  }

 private:
  static void add_bounds(Json& accessor, const Elements& elements) {
    for (const bool is_upper : {false, true}) {
      Json bounds = Json::array();
      for (uint32_t c = 0; c < elements.format.components; ++c) {
        double extreme = elements.number(0, c);
        for (uint64_t i = 1; i < elements.count; ++i)
          extreme = is_upper ? std::max(extreme, elements.number(i, c)) : std::min(extreme, elements.number(i, c));
        bounds.push_back(extreme);
      }
      accessor[is_upper ? "max" : "min"] = std::move(bounds);
    }
  }

  Json accessors_ = Json::array(), views_ = Json::array();
  std::string bytes_;
};

/// Returns an attribute in a format that glTF permits for it.
Elements attribute_elements(const Attribute& attribute, const AttributeFormat& format, bool flips) {
  const bool is_color = format.kind == AttributeKind::color && attribute.components >= 3;
  const double unit = format.normalized || is_color ? unit_value(format) : 1;
  Elements out = zero_elements({ComponentType::float32, attribute.components, false},
                               attribute.values.size() / attribute.components);
  for (size_t i = 0; i < attribute.values.size(); ++i) {
    const auto component = static_cast<uint32_t>(i % attribute.components);
    const double value = attribute.values[i] / unit;
    out.set_number(i / attribute.components, component, flips && component == 1 ? 1 - value : value);
  }
  return out;
}

/// Returns the triangles of a mesh by material; key 0 is without a material.
std::map<uint32_t, Buffer<Triangle>> triangles_by_material(const FormattedMesh& mesh, const Materials& materials) {
  std::map<uint32_t, Buffer<Triangle>> groups;  // by 1 + number of the material
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const uint32_t material = materials.of_triangle.empty() ? none : materials.of_triangle.at(t);
    groups[material + 1].push_back(mesh.triangles[t]);
  }
  return groups;
}

MaterialMesh flattened(const SceneMeshes& scene, const Limits& limits, MaterialReader* reader = nullptr) {
  uint64_t faces = 0;
  for (const SceneMesh& mesh : scene.meshes) faces += mesh.maps.size() * mesh.surface.vertices_of.size();
  require_within(faces, limits.max_input_faces, "faces once each node has its own");
  Flattener flattener(scene, reader);
  for (const SceneMesh& mesh : scene.meshes)
    for (const std::vector<Affine>& maps : mesh.maps) flattener.add(mesh, maps);
  return flattener.finish();
}

constexpr int vertex_target = 34962, index_target = 34963;

}  // namespace

FormattedMesh flatten_scene(std::string_view glb, const Limits& limits) {
  const Document document = read_document(glb);
  Views views(document);
  return flattened(read_meshes(views, limits), limits).mesh;
}

MaterialMesh flatten_with_materials(std::string_view glb, const Limits& limits) {
  const Document document = read_document(glb);
  Views views(document);
  MaterialReader reader(views);
  return flattened(read_meshes(views, limits), limits, &reader);
}

std::optional<FormattedMesh> find_only_mesh(std::string_view glb, const Limits& limits) {
  const Document document = read_document(glb);
  Views views(document);
  const SceneMeshes scene = read_meshes(views, limits);
  if (array_of(document.json, "meshes").size() != 1 || scene.meshes[0].maps.size() != 1) return std::nullopt;
  return flattened(scene, limits).mesh;
}

std::string scene_of_mesh(const FormattedMesh& mesh, const Materials& materials) {
  SceneBuilder builder;
  Elements positions = zero_elements({ComponentType::float32, 3, false}, mesh.positions.size());
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    positions.set_number(i, 0, mesh.positions[i].x);
    positions.set_number(i, 1, mesh.positions[i].y);
    positions.set_number(i, 2, mesh.positions[i].z);
  }
  Json attributes{{"POSITION", builder.add(positions, vertex_target, true)}};
  std::array<int, 4> numbers{};
  for (size_t a = 0; a < mesh.attributes.size(); ++a) {
    const AttributeFormat& format = mesh.format.attributes[a];
    if (mesh.attributes[a].components > 4) continue;
    const std::string semantic = semantic_of(format, mesh.attributes[a].components, numbers);
    const bool flips = semantic.starts_with("TEXCOORD_");
    attributes[semantic] = builder.add(attribute_elements(mesh.attributes[a], format, flips), vertex_target, false);
  }
  Json primitives = Json::array();
  for (const auto& [number, triangles] : triangles_by_material(mesh, materials)) {
    Elements indices = zero_elements({ComponentType::uint32, 1, false}, 3 * triangles.size());
    for (size_t i = 0; i < 3 * triangles.size(); ++i) indices.set_number(i, 0, triangles[i / 3][i % 3]);
    Json primitive{{"attributes", attributes}, {"indices", builder.add(indices, index_target, false)}};
    if (number > 0) primitive["material"] = number - 1;
    primitives.push_back(std::move(primitive));
  }
  return builder.finish(std::move(primitives), materials, attributes.contains("TEXCOORD_0"));
}

}  // namespace papilio::proto::gltf
