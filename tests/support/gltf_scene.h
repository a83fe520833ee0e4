#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "papilio/mesh.h"

namespace papilio::test {

/// Builder of a glTF scene with one buffer.
class GltfScene {
 public:
  using Json = nlohmann::ordered_json;

  GltfScene();

  Json json;
  std::string binary;

  /// Appends a view of these bytes; returns its index.
  size_t add_view(std::string_view bytes, std::optional<int> target = std::nullopt);
  /// Appends an accessor of tightly packed numbers; returns its index. `type`: "VEC3".
  template <class Number>
  size_t add_accessor(const std::vector<Number>& numbers, const std::string& type, bool normalized = false,
                      std::optional<int> target = std::nullopt) {
    const std::string_view bytes(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
    return add_described(add_view(bytes, target), component_type(Number{}), numbers.size(), type, normalized);
  }
  /// Appends the positions of a mesh, with their bounds.
  size_t add_positions(const Buffer<Vec3f>& positions);
  size_t add_indices(const Buffer<Triangle>& triangles);
  /// Appends a mesh of one primitive with only positions and indices, and a node with this mesh.
  size_t add_mesh(const TriangleMesh& mesh);
  /// Appends a node of the scene.
  size_t add_node(Json node);

  Json& primitive(size_t mesh = 0, size_t number = 0) { return json["meshes"][mesh]["primitives"][number]; }
  /// The scene as a .glb file.
  [[nodiscard]] std::string glb() const;
  /// The scene as a .gltf file with its buffer inside.
  [[nodiscard]] std::string gltf() const;

 private:
  static int component_type(int8_t) { return 5120; }
  static int component_type(uint8_t) { return 5121; }
  static int component_type(int16_t) { return 5122; }
  static int component_type(uint16_t) { return 5123; }
  static int component_type(uint32_t) { return 5125; }
  static int component_type(float) { return 5126; }
  size_t add_described(size_t view, int component, size_t numbers, const std::string& type, bool normalized);
};

/// Returns the JSON chunk of a .glb file, and its binary chunk.
[[nodiscard]] GltfScene::Json json_of_glb(std::string_view glb);
[[nodiscard]] std::string binary_of_glb(std::string_view glb);
/// Returns the bytes of a view of a .glb file.
[[nodiscard]] std::string view_of_glb(std::string_view glb, size_t view);

}  // namespace papilio::test
