#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "proto/gltf/document_writer.h"
#include "proto/gltf/geometry_writer.h"
#include "proto/gltf/vertices.h"
#include "proto/problem.h"
#include "tests/support/gltf_refinement.h"
#include "tests/support/shapes.h"

namespace papilio::proto::gltf {
namespace {

std::string_view compression_name(Compression compression) {
  return compression_names.at(static_cast<size_t>(compression));
}

using test::GltfScene;
using Json = GltfScene::Json;

/// Replaces the geometry of all meshes by a copy with each vertex twice.
std::string rewrite(const std::string& glb, Compression compression = Compression::same) {
  Document document = read_document(glb);
  Views views(document);
  Allowance allowance({});
  std::vector<EncodedGeometry> meshes;
  const GeometryEncoding encoding{.compression = compression, .draco = {}, .poll = {}};
  for (uint32_t m = 0; m < array_of(document.json, "meshes").size(); ++m) {
    NewGeometry mesh{.mesh = m, .geometry = read_geometry(views, m, allowance), .box = {}};
    for (VertexSet& set : mesh.geometry.sets) {
      const uint64_t count = set.count;
      for (VertexStream& stream : set.attributes) stream.elements.bytes += stream.elements.bytes;
      for (VertexStream& stream : set.attributes) stream.elements.count = 2 * count;
      set.count = 2 * count;
      mesh.box = quantization_box(vertex_positions(set));
    }
    if (!mesh.geometry.primitives.empty()) meshes.push_back(encode_geometry(document, std::move(mesh), encoding));
  }
  BufferPieces pieces = write_geometry(document, std::move(meshes), compression);
  return write_document(document, std::move(pieces), FileKind::glb).document;
}

/// Returns the number of bytes of the binary chunk outside of all views.
size_t dead_bytes(const std::string& glb) {
  const Json json = test::json_of_glb(glb);
  std::vector<bool> used(test::binary_of_glb(glb).size());
  const auto use = [&](const Json& of) {
    if (of["buffer"] != 0) return;
    const size_t begin = of.value("byteOffset", size_t{0});
    std::fill_n(used.begin() + static_cast<ptrdiff_t>(begin), of["byteLength"].get<size_t>(), true);
  };
  for (const Json& view : json["bufferViews"]) {
    use(view);
    if (view.contains("extensions")) use(view["extensions"]["EXT_meshopt_compression"]);
  }
  return static_cast<size_t>(std::ranges::count(used, false));
}

std::string marker(int number) { return "marker-" + std::to_string(number) + "-of-sixteen"; }

/// A scene with sixteen markers in elements that no refinement uses.
GltfScene marked_scene() {
  GltfScene scene;
  Json& json = scene.json;
  scene.add_view(marker(1));  // unused
  scene.add_mesh(test::icosahedron());
  json["asset"]["extras"] = marker(2);
  json["scenes"][0]["extras"] = marker(3);
  json["nodes"][0]["extras"] = marker(4);
  json["meshes"][0]["extras"] = marker(5);
  scene.primitive()["extras"] = marker(6);
  scene.primitive()["extensions"] = {{"EXT_unknown", {{"value", marker(7)}}}};
  json["accessors"][0]["extras"] = marker(8);
  json["bufferViews"][1]["name"] = marker(9);
  json["images"] = {{{"bufferView", scene.add_view(marker(10))}, {"mimeType", "image/png"}}};
  const size_t times = scene.add_accessor(std::vector<float>{0, 1}, "SCALAR");
  const size_t moves = scene.add_accessor(std::vector<float>{0, 0, 0, 1, 1, 1}, "VEC3");
  json["animations"] = {{{"name", marker(11)},
                         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
                         {"samplers", {{{"input", times}, {"output", moves}}}}}};
  json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}, {"name", marker(12)}}};
  json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"name", marker(13)}}};
  json["materials"] = {{{"extensions", {{"EXT_paint", {{"colour", marker(14)}}}}}}};
  json["accessors"].push_back({{"bufferView", scene.add_view(marker(15))},  // unused
                               {"componentType", 5121},
                               {"count", 16},
                               {"type", "SCALAR"}});
  scene.binary += marker(16);  // in no view
  return scene;
}

TEST(GltfWriter, AllSixteenMarkersSurvive) {
  const std::string before = marked_scene().glb();
  for (const std::string_view name : compression_names) {
    const std::string after = test::refined(before, {{"levels", "2"}, {"output.compress", std::string(name)}}).bytes;
    for (int number = 1; number <= 16; ++number)
      EXPECT_NE(after.find(marker(number)), std::string::npos) << name << ' ' << number;
  }
}

TEST(GltfWriter, OtherElementsKeepTheirPlacesAndBytes) {
  const std::string before = marked_scene().glb();
  const std::string after = rewrite(before);
  const Json old_json = test::json_of_glb(before);
  const Json new_json = test::json_of_glb(after);
  EXPECT_EQ(old_json["accessors"].size(), new_json["accessors"].size());
  ASSERT_EQ(old_json["bufferViews"].size(), new_json["bufferViews"].size());
  for (size_t v = 0; v < old_json["bufferViews"].size(); ++v) {
    const bool is_geometry = v == 1;  // the indices are the same
    EXPECT_EQ(test::view_of_glb(before, v) == test::view_of_glb(after, v), !is_geometry) << v;
  }
  for (const char* name : {"animations", "images", "cameras", "materials", "nodes", "scenes", "asset"})
    EXPECT_EQ(old_json[name].dump(), new_json[name].dump());
  EXPECT_EQ(old_json["meshes"][0]["primitives"][0].dump(), new_json["meshes"][0]["primitives"][0].dump());
}

TEST(GltfWriter, OldGeometryIsRemoved) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  const std::string before = scene.glb();
  const std::string after = rewrite(before);
  EXPECT_LT(dead_bytes(after), 16U);
  EXPECT_EQ(test::view_of_glb(after, 0), test::view_of_glb(before, 0) + test::view_of_glb(before, 0));
  EXPECT_EQ(after.find(test::view_of_glb(before, 0)), after.rfind(test::view_of_glb(before, 0)) - 144);
}

TEST(GltfWriter, SharedAccessorIsKept) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  Json points = scene.primitive();
  points["mode"] = 0;
  points.erase("indices");
  scene.json["meshes"][0]["primitives"].push_back(points);
  const std::string before = scene.glb();
  const Json after = test::json_of_glb(rewrite(before));
  EXPECT_EQ(after["meshes"][0]["primitives"][1], points);
  EXPECT_EQ(after["meshes"][0]["primitives"][0]["attributes"]["POSITION"], 2);
  EXPECT_EQ(test::view_of_glb(rewrite(before), 0), test::view_of_glb(before, 0));
}

/// A scene without indices whose only view has the positions of two meshes, one of them of points.
GltfScene shared_view_scene() {
  GltfScene scene;
  std::vector<float> numbers(36);
  for (size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(i * i);
  scene.add_view({reinterpret_cast<const char*>(numbers.data()), 4 * numbers.size()});
  for (int mesh = 0; mesh < 2; ++mesh) {
    scene.json["accessors"].push_back(
        {{"bufferView", 0}, {"byteOffset", 72 * mesh}, {"componentType", 5126}, {"count", 6}, {"type", "VEC3"}});
    scene.json["meshes"].push_back(
        {{"primitives", {{{"attributes", {{"POSITION", mesh}}}, {"mode", mesh == 0 ? 4 : 0}}}}});
  }
  return scene;
}

TEST(GltfWriter, ReplacedPartOfASharedViewIsRemoved) {
  const std::string before = shared_view_scene().glb();
  const std::string after = rewrite(before);
  const Json json = test::json_of_glb(after);
  EXPECT_EQ(json["bufferViews"][0]["byteLength"].get<int>() / 16, 80 / 16);
  const size_t offset = json["accessors"][1]["byteOffset"];
  EXPECT_EQ(test::view_of_glb(after, 0).substr(offset, 72), test::view_of_glb(before, 0).substr(72, 72));
  EXPECT_LT(dead_bytes(after), 32U);
}

TEST(GltfWriter, PositionsRoundTripInEachCompression) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  const auto positions_of = [](const std::string& glb) {
    const Document document = read_document(glb);
    Views views(document);
    Allowance allowance({});
    const MeshGeometry found = read_geometry(views, 0, allowance);
    const Buffer<Vec3f> positions = vertex_positions(found.sets[0]);
    std::multiset<std::array<int, 3>> corners;  // in thousandths
    for (const Triangle& triangle : found.primitives[0].triangles)
      for (const uint32_t v : triangle)
        corners.insert({static_cast<int>(std::floor(positions[v].x * 1000 + 0.5F)),
                        static_cast<int>(std::floor(positions[v].y * 1000 + 0.5F)),
                        static_cast<int>(std::floor(positions[v].z * 1000 + 0.5F))});
    return corners;
  };
  std::string glb = scene.glb();
  const auto expected = positions_of(glb);
  const std::vector<std::pair<Compression, const char*>> steps{{Compression::draco, "KHR_draco_mesh_compression"},
                                                               {Compression::same, "KHR_draco_mesh_compression"},
                                                               {Compression::meshopt, "EXT_meshopt_compression"},
                                                               {Compression::same, "EXT_meshopt_compression"},
                                                               {Compression::none, nullptr},
                                                               {Compression::same, nullptr}};
  for (const auto& [compression, extension] : steps) {
    glb = rewrite(glb, compression);
    const Json json = test::json_of_glb(glb);
    EXPECT_EQ(json.contains("extensionsRequired"), extension != nullptr) << compression_name(compression);
    if (extension != nullptr) {
      EXPECT_EQ(json["extensionsRequired"], Json::array({extension}));
    }
    EXPECT_LT(dead_bytes(glb), 64U) << compression_name(compression);
    const auto found = positions_of(glb);
    EXPECT_EQ(found.size(), expected.size());
    size_t near = 0;
    for (const auto& corner : found)
      near += static_cast<size_t>(std::ranges::any_of(expected, [&](const auto& other) {
        return std::abs(corner[0] - other[0]) <= 1 && std::abs(corner[1] - other[1]) <= 1 &&
               std::abs(corner[2] - other[2]) <= 1;
      }));
    EXPECT_EQ(near, found.size());
  }
}

TEST(GltfWriter, BoundsOfPositionsAreRecomputed) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  const Json before = scene.json["accessors"][0];
  scene.json["accessors"][0]["min"] = {9, 9, 9};
  const Json after = test::json_of_glb(rewrite(scene.glb()))["accessors"][0];
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(after["min"][i].get<float>(), before["min"][i].get<float>());
}

TEST(GltfWriter, DocumentsWithoutViewsAreWritten) {
  // Adding lists invalidated the reference to the primitive while it was written.
  Document document = read_document(R"({"asset": {"version": "2.0"}, "accessors": [{"componentType": 5126, "count": 3,
      "type": "VEC3"}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]})");
  Views views(document);
  Allowance allowance({});
  std::vector<EncodedGeometry> meshes;
  NewGeometry mesh{.mesh = 0, .geometry = read_geometry(views, 0, allowance), .box = {}};
  meshes.push_back(encode_geometry(document, std::move(mesh), {.compression = {}, .draco = {}, .poll = {}}));
  BufferPieces pieces = write_geometry(document, std::move(meshes), Compression::same);
  const std::string glb = write_document(document, std::move(pieces), FileKind::glb).document;
  const Json json = test::json_of_glb(glb);
  ASSERT_TRUE(json.contains("bufferViews"));
  EXPECT_TRUE(json["accessors"][0].contains("bufferView"));
  EXPECT_TRUE(json["meshes"][0]["primitives"][0].contains("indices"));
  EXPECT_LT(dead_bytes(glb), 16U);
}

}  // namespace
}  // namespace papilio::proto::gltf
