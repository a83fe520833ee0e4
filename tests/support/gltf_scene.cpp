#include "tests/support/gltf_scene.h"

#include <algorithm>

#include "proto/gltf/container.h"
#include "proto/gltf/data_uri.h"

namespace papilio::test {
namespace {

size_t components_of(const std::string& type) {
  if (type == "SCALAR") return 1;
  return type == "MAT4" ? 16 : static_cast<size_t>(type.back() - '0');
}

}  // namespace

GltfScene::GltfScene()
    : json{{"asset", {{"version", "2.0"}}},
           {"scene", 0},
           {"scenes", Json::array({{{"nodes", Json::array()}}})},
           {"nodes", Json::array()},
           {"meshes", Json::array()},
           {"accessors", Json::array()},
           {"bufferViews", Json::array()}} {}

size_t GltfScene::add_view(std::string_view bytes, std::optional<int> target) {
  binary.resize((binary.size() + 3) / 4 * 4);
  Json view{{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
  if (target) view["target"] = *target;
  binary += bytes;
  json["bufferViews"].push_back(view);
  return json["bufferViews"].size() - 1;
}

size_t GltfScene::add_described(size_t view, int component, size_t numbers, const std::string& type, bool normalized) {
  Json accessor{
      {"bufferView", view}, {"componentType", component}, {"count", numbers / components_of(type)}, {"type", type}};
  if (normalized) accessor["normalized"] = true;
  json["accessors"].push_back(accessor);
  return json["accessors"].size() - 1;
}

size_t GltfScene::add_positions(const Buffer<Vec3f>& positions) {
  std::vector<float> numbers;
  for (const Vec3f& p : positions) numbers.insert(numbers.end(), {p.x, p.y, p.z});
  const size_t accessor = add_accessor(numbers, "VEC3", false, 34962);
  const Box box = bounding_box(positions);
  json["accessors"][accessor]["min"] = {box.min.x, box.min.y, box.min.z};
  json["accessors"][accessor]["max"] = {box.max.x, box.max.y, box.max.z};
  return accessor;
}

size_t GltfScene::add_indices(const Buffer<Triangle>& triangles) {
  std::vector<uint16_t> numbers;
  for (const Triangle& triangle : triangles)
    for (const uint32_t v : triangle) numbers.push_back(static_cast<uint16_t>(v));
  return add_accessor(numbers, "SCALAR", false, 34963);
}

size_t GltfScene::add_mesh(const TriangleMesh& mesh) {
  const Json positions = add_positions(mesh.positions);
  const Json indices = add_indices(mesh.triangles);
  const Json primitive{{"attributes", {{"POSITION", positions}}}, {"indices", indices}};
  json["meshes"].push_back({{"primitives", Json::array({primitive})}});
  add_node({{"mesh", json["meshes"].size() - 1}});
  return json["meshes"].size() - 1;
}

size_t GltfScene::add_node(Json node) {
  json["nodes"].push_back(std::move(node));
  json["scenes"][0]["nodes"].push_back(json["nodes"].size() - 1);
  return json["nodes"].size() - 1;
}

std::string GltfScene::glb() const {
  Json document = json;
  std::optional<std::vector<proto::gltf::Piece>> chunk;
  if (!binary.empty()) {
    if (!document.contains("buffers")) document["buffers"] = Json::array({Json::object()});
    document["buffers"][0]["byteLength"] = binary.size();
    chunk = std::vector<proto::gltf::Piece>{{binary}};
  }
  return proto::gltf::write_glb(document.dump(), std::move(chunk), {});
}

std::string GltfScene::gltf() const {
  Json document = json;
  document["buffers"] =
      Json::array({{{"byteLength", binary.size()}, {"uri", proto::gltf::encode_data_uri(binary, "")}}});
  return document.dump();
}

GltfScene::Json json_of_glb(std::string_view glb) { return GltfScene::Json::parse(proto::gltf::read_glb(glb).json); }

std::string binary_of_glb(std::string_view glb) {
  return std::string(proto::gltf::read_glb(glb).binary.value_or(std::string_view()));
}

std::string view_of_glb(std::string_view glb, size_t view) {
  const GltfScene::Json json = json_of_glb(glb)["bufferViews"][view];
  return binary_of_glb(glb).substr(json.value("byteOffset", size_t{0}), json["byteLength"].get<size_t>());
}

}  // namespace papilio::test
