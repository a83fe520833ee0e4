#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "proto/gltf/data_uri.h"
#include "proto/gltf/flattening.h"
#include "proto/gltf/packing.h"
#include "proto/problem.h"
#include "tests/support/gltf_scene.h"
#include "tests/support/shapes.h"

namespace papilio::proto::gltf {
namespace {

using test::GltfScene;
using Json = GltfScene::Json;

std::string no_file(const std::string& uri) {
  ADD_FAILURE() << uri << " is read";
  return {};
}

std::multiset<std::array<float, 3>> corners_of(const TriangleMesh& mesh) {
  std::multiset<std::array<float, 3>> corners;
  for (const Triangle& triangle : mesh.triangles)
    for (const uint32_t v : triangle) corners.insert({mesh.positions[v].x, mesh.positions[v].y, mesh.positions[v].z});
  return corners;
}

double volume_of(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum +=
        dot(to_double(mesh.positions[t[0]]), cross(to_double(mesh.positions[t[1]]), to_double(mesh.positions[t[2]])));
  return sum / 6;
}

TEST(GltfPacking, BuffersAndImagesBecomeOneChunk) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  Json json = scene.json;
  json["buffers"] = {{{"byteLength", scene.binary.size()}, {"uri", "a%20b.bin"}, {"extras", "kept"}},
                     {{"byteLength", 5}, {"uri", encode_data_uri("12345", "")}}};
  json["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 1}, {"byteLength", 3}});
  json["images"] = {{{"uri", "photo.JPG"}},
                    {{"uri", encode_data_uri("inside", "data:image/png;base64,")}},
                    {{"uri", "photo.unknown"}},
                    {{"uri", "lost.png"}}};
  std::vector<std::string> asked;
  const auto buffer = [&](const std::string& uri) {
    asked.push_back(uri);
    return scene.binary;
  };
  const auto image = [&](const std::string& uri) -> std::optional<std::string> {
    asked.push_back(uri);
    if (uri == "lost.png") return std::nullopt;
    return "outside";
  };
  const std::string glb = pack_scene(json.dump(), buffer, image);
  EXPECT_EQ(asked, (std::vector<std::string>{"a%20b.bin", "photo.JPG", "lost.png"}));
  const Json packed = test::json_of_glb(glb);
  ASSERT_EQ(packed["buffers"].size(), 1U);
  EXPECT_EQ(packed["buffers"][0]["extras"], "kept");
  EXPECT_FALSE(packed["buffers"][0].contains("uri"));
  EXPECT_EQ(test::view_of_glb(glb, 2), "234");
  EXPECT_EQ(test::view_of_glb(glb, packed["images"][0]["bufferView"]), "outside");
  EXPECT_EQ(packed["images"][0]["mimeType"], "image/jpeg");
  EXPECT_EQ(test::view_of_glb(glb, packed["images"][1]["bufferView"]), "inside");
  EXPECT_EQ(packed["images"][2]["uri"], "photo.unknown");
  EXPECT_EQ(packed["images"][3].dump(), R"({"uri":"lost.png"})");
  EXPECT_EQ(corners_of(flatten_scene(glb, {})), corners_of(test::icosahedron()));
}

TEST(GltfPacking, BufferWithConflictingExtrasStaysSeparate) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  Json json = scene.json;
  json["buffers"] = {{{"byteLength", scene.binary.size()}, {"uri", "a.bin"}, {"extras", "first"}},
                     {{"byteLength", 5}, {"uri", "b.bin"}, {"extras", {{"number", 2}}}, {"name", "second"}},
                     {{"byteLength", 5}, {"uri", "b.bin"}}};
  json["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 1}, {"byteLength", 3}});
  json["bufferViews"].push_back({{"buffer", 2}, {"byteOffset", 1}, {"byteLength", 3}});
  const auto buffer = [&](const std::string& uri) { return uri == "a.bin" ? scene.binary : "12345"; };
  const std::string glb = pack_scene(json.dump(), buffer, [](const std::string&) { return std::nullopt; });
  const Json packed = test::json_of_glb(glb);
  ASSERT_EQ(packed["buffers"].size(), 2U);
  EXPECT_EQ(packed["buffers"][0]["extras"], "first");
  EXPECT_EQ(packed["buffers"][1]["extras"], (Json{{"number", 2}}));
  EXPECT_EQ(packed["buffers"][1]["name"], "second");
  EXPECT_EQ(decode_data_uri(packed["buffers"][1]["uri"].get<std::string>()), "12345");
  EXPECT_EQ(packed["bufferViews"][2]["buffer"], 1);
  EXPECT_EQ(packed["bufferViews"][2]["byteOffset"], 1);
  EXPECT_EQ(packed["bufferViews"][3]["buffer"], 0);
  EXPECT_EQ(test::view_of_glb(glb, 3), "234");
  EXPECT_EQ(corners_of(flatten_scene(glb, {})), corners_of(test::icosahedron()));
}

TEST(GltfPacking, GlbFileIsUnchanged) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  EXPECT_EQ(pack_scene(scene.glb(), no_file, no_file), scene.glb());
  const UnpackedScene unpacked = unpack_scene(scene.glb(), "x.bin");
  EXPECT_EQ(unpacked.buffers.at(0), (std::pair<std::string, std::string>{"x.bin", scene.binary}));
  const auto binary = [&](const std::string&) { return scene.binary; };
  EXPECT_EQ(pack_scene(unpacked.document, binary, no_file), scene.glb());
}

TEST(GltfFlattening, EveryNodeContributesItsTriangles) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  scene.add_node({{"mesh", 0}, {"scale", {-2, 2, 2}}, {"translation", {9, 0, 0}}});  // mirrored
  const FormattedMesh flat = flatten_scene(scene.glb(), {});
  EXPECT_EQ(flat.triangles.size(), 40U);
  EXPECT_NEAR(volume_of(flat), 9 * volume_of(test::icosahedron()), 1e-4);  // both wound outwards
  EXPECT_THROW((void)flatten_scene(scene.glb(), {.max_input_faces = 39}), Problem);
  EXPECT_FALSE(find_only_mesh(scene.glb(), {}));
}

TEST(GltfFlattening, TrianglesWithoutNormalsGetFaceNormals) {
  const TriangleMesh shape = test::icosahedron();
  GltfScene scene;
  scene.add_mesh(shape);
  scene.primitive()["attributes"]["NORMAL"] = scene.add_positions(shape.positions);
  scene.add_mesh(shape);  // without normals
  scene.json["nodes"][1]["scale"] = {-2, 1, 1};
  const FormattedMesh flat = flatten_scene(scene.glb(), {});
  ASSERT_EQ(flat.triangles.size(), 40U);
  ASSERT_EQ(flat.attributes.size(), 1U);
  EXPECT_EQ(flat.positions.size(), shape.positions.size() + 3 * shape.triangles.size());
  for (size_t t = shape.triangles.size(); t < flat.triangles.size(); ++t) {
    const auto [a, b, c] = flat.triangles[t];
    const Vec3d at = to_double(flat.positions[a]);
    const Vec3d across = cross(to_double(flat.positions[b]) - at, to_double(flat.positions[c]) - at);
    EXPECT_GT(dot(across, at), 0) << "wound outwards";
    for (const uint32_t v : {a, b, c}) {
      const double* n = &flat.attributes[0].values[size_t{3} * v];
      EXPECT_LT(length(1 / length(across) * across - Vec3d{n[0], n[1], n[2]}), 1e-6);
    }
  }
}

TEST(GltfFlattening, VerticesWithoutColoursAreWhite) {
  const TriangleMesh shape = test::icosahedron();
  GltfScene scene;
  scene.add_mesh(shape);
  scene.primitive()["attributes"]["COLOR_0"] =
      scene.add_accessor(std::vector<float>(3 * shape.positions.size(), 0.4F), "VEC3");
  scene.add_mesh(shape);  // without colours
  const FormattedMesh flat = flatten_scene(scene.glb(), {});
  ASSERT_EQ(flat.attributes.size(), 1U);
  const std::vector<double>& colors = flat.attributes[0].values;
  ASSERT_EQ(colors.size(), 8 * shape.positions.size());
  EXPECT_NEAR(colors[0], 0.4 * 255, 1e-4);
  for (size_t i = colors.size() / 2; i < colors.size(); ++i) EXPECT_EQ(colors[i], 255);
}

TEST(GltfFlattening, MeshRoundTripsThroughAScene) {
  FormattedMesh mesh{test::icosahedron(), {}};
  mesh.attributes = {{.components = 2, .unit_length = false, .values = std::vector<double>(24, 0.25)},
                     {.components = 4, .unit_length = false, .values = std::vector<double>(48, 51)}};
  mesh.format.attributes = {
      {.kind = AttributeKind::tex_coord, .type = ValueType::float32, .normalized = false, .id = 1},
      {.kind = AttributeKind::color, .type = ValueType::uint8, .normalized = true, .id = 2}};
  const std::string glb = scene_of_mesh(mesh);
  const auto back = find_only_mesh(glb, {});
  ASSERT_TRUE(back);
  EXPECT_EQ(back->positions, mesh.positions);
  EXPECT_EQ(back->triangles, mesh.triangles);
  ASSERT_EQ(back->attributes.size(), 2U);
  for (const double v : back->attributes[0].values) EXPECT_EQ(v, 0.25);
  for (const double v : back->attributes[1].values) EXPECT_NEAR(v, 51, 1e-4);
}

}  // namespace
}  // namespace papilio::proto::gltf
