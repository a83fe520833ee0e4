#include "proto/gltf/flattening.h"

#include <algorithm>
#include <array>

#include "proto/draco_header.h"
#include "proto/gltf/document_writer.h"
#include "proto/gltf/scene_mesh.h"
#include "proto/gltf/vertices.h"
#include "proto/problem.h"

namespace papilio::proto::gltf {
namespace {

/// Attributes that a flat mesh keeps.
struct FlatAttribute {
  const char* semantic;
  AttributeKind kind;
  uint32_t components;
};
constexpr std::array flat_attributes{FlatAttribute{"NORMAL", AttributeKind::normal, 3},
                                     FlatAttribute{"TEXCOORD_0", AttributeKind::tex_coord, 2},
                                     FlatAttribute{"COLOR_0", AttributeKind::color, 4}};

/// Returns the direction of a normal on a surface that is moved.
Vec3d moved_normal(const Affine& map, Vec3d normal) {
  const auto& [x, y, z] = map.axes;
  Vec3d moved = normal.x * cross(y, z) + normal.y * cross(z, x) + normal.z * cross(x, y);
  if (dot(cross(x, y), z) < 0) moved = -1.0 * moved;
  const double size = length(moved);
  return size > 0 ? 1 / size * moved : normal;
}

class Flattener {
 public:
  explicit Flattener(const SceneMeshes& scene) {
    for (const FlatAttribute& attribute : flat_attributes)
      for (const SceneMesh& mesh : scene.meshes)
        for (const VertexSet& set : mesh.geometry.sets)
          if (set.find(attribute.semantic) != nullptr) add_attribute(attribute);
  }

  void add(const SceneMesh& mesh, const std::vector<Affine>& maps) {
    for (const VertexSet& set : mesh.geometry.sets) {
      const auto first = static_cast<uint32_t>(out_.positions.size());
      const Buffer<Vec3f> positions = vertex_positions(set);
      for (uint32_t i = 0; i < set.count; ++i) {
        out_.positions.push_back(to_float(maps[0].point(to_double(positions[i]))));
        for (size_t a = 0; a < used_.size(); ++a) append(a, set, i, maps[0]);
      }
      const auto number = static_cast<uint32_t>(&set - mesh.geometry.sets.data());
      for (const TrianglePrimitive& primitive : mesh.geometry.primitives)
        if (primitive.set == number) add_triangles(primitive.triangles, first, maps[0]);
    }
  }

  FormattedMesh finish() { return std::move(out_); }

 private:
  void add_attribute(const FlatAttribute& attribute) {
    if (std::ranges::find(used_, attribute.semantic, &FlatAttribute::semantic) != used_.end()) return;
    used_.push_back(attribute);
    out_.attributes.push_back(
        {.components = attribute.components, .unit_length = attribute.kind == AttributeKind::normal, .values = {}});
    const bool is_color = attribute.kind == AttributeKind::color;
    out_.format.attributes.push_back({.kind = attribute.kind,
                                      .type = is_color ? ValueType::uint8 : ValueType::float32,
                                      .normalized = is_color,
                                      .id = static_cast<uint32_t>(used_.size())});
  }

  void append(size_t number, const VertexSet& set, uint32_t vertex, const Affine& map) {
    const FlatAttribute& attribute = used_[number];
    const VertexStream* stream = set.find(attribute.semantic);
    std::array<double, 4> value{0, 0, 0, attribute.kind == AttributeKind::color ? 1.0 : 0.0};
    const uint32_t given = stream == nullptr ? 0 : std::min(stream->elements.format.components, attribute.components);
    for (uint32_t c = 0; c < given; ++c) value[c] = stream->elements.number(vertex, c) * stream->elements.format.unit();
    if (attribute.kind == AttributeKind::normal && given > 0) {
      const Vec3d moved = moved_normal(map, {value[0], value[1], value[2]});
      value = {moved.x, moved.y, moved.z, 0};
    }
    if (attribute.kind == AttributeKind::tex_coord) value[1] = 1 - value[1];
    constexpr double color_range = 255;
    std::vector<double>& values = out_.attributes[number].values;
    for (uint32_t c = 0; c < attribute.components; ++c)
      values.push_back(attribute.kind == AttributeKind::color ? std::clamp(value[c], 0.0, 1.0) * color_range
                                                              : value[c]);
  }

  /// Mirrored maps turn triangles over.
  void add_triangles(const Buffer<Triangle>& triangles, uint32_t first, const Affine& map) {
    const bool is_mirrored = dot(cross(map.axes[0], map.axes[1]), map.axes[2]) < 0;
    for (const Triangle& t : triangles) {
      Triangle moved{first + t[0], first + t[1], first + t[2]};
      if (is_mirrored) std::swap(moved[1], moved[2]);
      out_.triangles.push_back(moved);
    }
  }

  std::vector<FlatAttribute> used_;
  FormattedMesh out_;
};

/// Semantic of an attribute in glTF; `numbers` counts those of each kind.
std::string semantic_of(const AttributeFormat& format, uint32_t components, std::array<int, 4>& numbers) {
  int& number = numbers.at(static_cast<size_t>(format.kind));
  const bool is_float = format.type == ValueType::float32;
  const std::string count = std::to_string(number);
  if (format.kind == AttributeKind::normal && components == 3 && is_float && number++ == 0) return "NORMAL";
  if (format.kind == AttributeKind::tex_coord && components == 2 && is_float) return ++number, "TEXCOORD_" + count;
  if (format.kind == AttributeKind::color && components >= 3) return ++number, "COLOR_" + count;
  int& others = numbers[3];
  return "_ATTRIBUTE_" + std::to_string(others++);
}

/// Appends accessors, views and bytes of new elements.
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
    views_.push_back(
        {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", elements.bytes.size()}, {"target", target}});
    bytes_ += elements.bytes;
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    accessors_.push_back(std::move(accessor));
    return static_cast<uint32_t>(accessors_.size() - 1);
  }

  std::string finish(Json primitive) {
    Json json{{"asset", {{"version", "2.0"}, {"generator", "papilio"}}}, {"scene", 0}};
    json["scenes"] = Json::array({{{"nodes", {0}}}});
    json["nodes"] = Json::array({{{"mesh", 0}}});
    json["meshes"] = Json::array({{{"primitives", Json::array({std::move(primitive)})}}});
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

/// Returns an attribute in a format that glTF allows for it.
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

FormattedMesh flattened(const SceneMeshes& scene, const Limits& limits) {
  uint64_t faces = 0;
  for (const SceneMesh& mesh : scene.meshes) faces += mesh.maps.size() * mesh.surface.vertices_of.size();
  require_within(faces, limits.max_input_faces, "faces once each node has its own");
  Flattener flattener(scene);
  for (const SceneMesh& mesh : scene.meshes)
    for (const std::vector<Affine>& maps : mesh.maps) flattener.add(mesh, maps);
  return flattener.finish();
}

constexpr int vertex_target = 34962, index_target = 34963;

}  // namespace

FormattedMesh flatten_scene(std::string_view glb, const Limits& limits) {
  const Document document = read_document(glb);
  Views views(document);
  return flattened(read_meshes(views, limits), limits);
}

std::optional<FormattedMesh> find_only_mesh(std::string_view glb, const Limits& limits) {
  const Document document = read_document(glb);
  Views views(document);
  const SceneMeshes scene = read_meshes(views, limits);
  if (array_of(document.json, "meshes").size() != 1 || scene.meshes[0].maps.size() != 1) return std::nullopt;
  return flattened(scene, limits);
}

std::string scene_of_mesh(const FormattedMesh& mesh) {
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
  Elements indices = zero_elements({ComponentType::uint32, 1, false}, 3 * mesh.triangles.size());
  for (size_t i = 0; i < 3 * mesh.triangles.size(); ++i) indices.set_number(i, 0, mesh.triangles[i / 3][i % 3]);
  const uint32_t index_accessor = builder.add(indices, index_target, false);
  return builder.finish({{"attributes", std::move(attributes)}, {"indices", index_accessor}});
}

}  // namespace papilio::proto::gltf
