#include "tests/support/scene_memory.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "papilio/refine.h"
#include "proto/gltf/accessor.h"
#include "proto/gltf/scene_refinement.h"
#include "tests/support/packed_model.h"
#include "tests/support/peak_memory.h"
#include "tests/support/shapes.h"

namespace papilio::test {
namespace {

using proto::QueryFields;

constexpr int levels = 3;
constexpr size_t image_bytes = 40'000'000;

QueryFields fields_of(const char* compression = "same") {
  return {{"levels", std::to_string(levels)}, {"output.compress", compression}};
}

std::string scene_of(const TriangleMesh& mesh, int count = 1) {
  GltfScene scene;
  for (int m = 0; m < count; ++m) scene.add_mesh(mesh);
  return scene.glb();
}

std::string dressed_scene(const TriangleMesh& mesh, bool is_skinned) {
  GltfScene scene;
  scene.add_mesh(mesh);
  dress(scene, mesh, is_skinned);
  return scene.glb();
}

/// Returns a skinned scene in which all attributes declare their bounds.
std::string bounded_scene(const TriangleMesh& mesh) {
  GltfScene scene;
  scene.add_mesh(mesh);
  dress(scene, mesh, true);
  for (const auto& [semantic, accessor] : scene.primitive()["attributes"].items())
    declare_bounds(scene, accessor.get<size_t>());
  return scene.glb();
}

std::string scene_with_image(const TriangleMesh& mesh) {
  GltfScene scene;
  scene.add_mesh(mesh);
  const size_t view = scene.add_view(std::string(image_bytes, 'x'));
  scene.json["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
  return scene.glb();
}

std::string compressed(const std::string& glb) {
  const QueryFields fields{{"levels", "0"}, {"output.compress", "meshopt"}};
  return proto::gltf::SceneRefinement(glb, proto::parse_query(fields), {}).run().bytes;
}

}  // namespace

void dress(GltfScene& scene, const TriangleMesh& mesh, bool is_skinned, size_t number) {
  std::vector<float> normals, places, weights;
  std::vector<uint8_t> joints;
  for (const Vec3f& p : mesh.positions) {
    const float size = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
    const float unit = size > 0 ? 1 / size : 0;
    normals.insert(normals.end(), {p.x * unit, p.y * unit, size > 0 ? p.z * unit : 1});
    places.insert(places.end(), {std::sin(p.x), std::cos(p.y)});
    const float share = 0.5F + 0.25F * std::sin(p.z);
    weights.insert(weights.end(), {share, 1 - share, 0, 0});
    joints.insert(joints.end(), {0, 1, 0, 0});
  }
  auto& attributes = scene.primitive(number)["attributes"];
  attributes["NORMAL"] = scene.add_accessor(normals, "VEC3");
  attributes["TEXCOORD_0"] = scene.add_accessor(places, "VEC2");
  if (!is_skinned) return;
  attributes["JOINTS_0"] = scene.add_accessor(joints, "VEC4");
  attributes["WEIGHTS_0"] = scene.add_accessor(weights, "VEC4");
}

void declare_bounds(GltfScene& scene, size_t accessor) {
  GltfScene::Json& json = scene.json["accessors"][accessor];
  const GltfScene::Json& view = scene.json["bufferViews"][json["bufferView"].get<size_t>()];
  const proto::gltf::Elements elements{
      .format = proto::gltf::element_format(GltfScene::Json::parse(json.dump()), "an accessor"),  // unsigned numbers
      .count = json["count"].get<uint64_t>(),
      .bytes = scene.binary.substr(view["byteOffset"].get<size_t>(), view["byteLength"].get<size_t>())};
  json["min"] = json["max"] = GltfScene::Json::array();
  for (uint32_t c = 0; c < elements.format.components; ++c) {
    double low = elements.number(0, c);
    double high = low;
    for (uint64_t i = 1; i < elements.count; ++i) {
      low = std::min(low, elements.number(i, c));
      high = std::max(high, elements.number(i, c));
    }
    json["min"].push_back(low);
    json["max"].push_back(high);
  }
}

SceneMemory measure_scene(const std::string& glb, const QueryFields& fields, const std::function<void()>& prepare) {
  constexpr double mebibyte = 1 << 20;
  const proto::Parameters parameters = proto::parse_query(fields);
  const auto refine_scene = [&](const std::string& scene) {
    const std::string own = scene;
    if (proto::gltf::SceneRefinement(own, parameters, {}).run().bytes.empty()) std::abort();
  };
  const auto before = [&] {
    prepare();
    refine_scene(dressed_scene(tetrahedron(), true));  // loads pages of the code
  };
  SceneMemory found;
  found.taken = peak_memory_of([&] { refine_scene(glb); }, before);
  const double of_core = peak_memory_of(
      [&] {
        std::vector<Mesh> meshes;  // with the origin (face and position) and normals of their points
        for (auto& mesh : proto::gltf::decode_scene(glb, {}).scene.meshes)
          meshes.push_back(std::move(mesh.surface.mesh));
        for (const Mesh& mesh : meshes)
          if (refine(mesh, {.levels = levels, .edges = false}).mesh.topology.face_count() == 0) std::abort();
      },
      before);
  const double written = in_child_process(
      [&] { return static_cast<double>(proto::gltf::SceneRefinement(glb, parameters, {}).run().bytes.size()); });
  found.allowed = static_cast<double>(glb.size()) / mebibyte + written / mebibyte + of_core;
  return found;
}

std::vector<MeasuredScene> measured_scenes(const TriangleMesh& mesh, const TriangleMesh& small) {
  return {{"positions, small", scene_of(small), fields_of()},
          {"positions", scene_of(mesh), fields_of()},
          {"40 MB of images", scene_with_image(mesh), fields_of()},
          {"20 small meshes", scene_of(small, 20), fields_of()},
          {"normals and texture", dressed_scene(mesh, false), fields_of()},
          {"skin", dressed_scene(mesh, true), fields_of()},
          {"meshopt in and out", compressed(scene_of(mesh)), fields_of()},
          {"meshopt, skin", compressed(dressed_scene(mesh, true)), fields_of()},
          {"to Draco", scene_of(mesh), fields_of("draco")},
          {"to Draco, normals and texture, small", dressed_scene(small, false), fields_of("draco")},
          {"to Draco, normals and texture", dressed_scene(mesh, false), fields_of("draco")},
          {"to Draco, skin, small", dressed_scene(small, true), fields_of("draco")},
          {"to Draco, skin", dressed_scene(mesh, true), fields_of("draco")},
          {"to Draco, skin with bounds", bounded_scene(mesh), fields_of("draco")}};
}

MeasuredScene measured_packed_model(const TriangleMesh& base) {
  return {"packed model", packed_fixture(base, 2, 2 * base.triangles.size()).glb, fields_of()};
}

}  // namespace papilio::test
