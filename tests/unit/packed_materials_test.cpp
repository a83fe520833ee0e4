#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "papilio/refine.h"
#include "proto/detail/decode_packed.h"
#include "proto/detail/pack.h"
#include "proto/detail/packed_reader.h"
#include "proto/gltf/flattening.h"
#include "tests/support/gltf_scene.h"
#include "tests/support/images.h"
#include "tests/support/shapes.h"

// Materials of glTF scenes in packed models.

namespace papilio::proto::detail {
namespace {

using test::GltfScene;
using Json = GltfScene::Json;

Json number_texture(size_t index) { return {{"index", index}}; }

/// A smooth ball with texture coordinates and two materials, of which only the second is used: it has all that
/// `gltf::Material` lacks.
GltfScene scene_of_ball(int levels) {
  Options options;
  options.levels = levels;
  options.tension = Tension::off;
  const TriangleMesh ball = refine(build_mesh(test::icosahedron()), options).mesh.triangles();
  GltfScene scene;
  scene.add_mesh(ball);
  std::vector<float> texcoords;
  for (const Vec3f p : ball.positions) texcoords.insert(texcoords.end(), {p.x / 4 + 0.5F, p.y / 4 + 0.5F});
  scene.primitive()["attributes"]["TEXCOORD_0"] = scene.add_accessor(texcoords, "VEC2");
  scene.primitive()["material"] = 1;
  Json coat{{"clearcoatFactor", 0.75}, {"clearcoatTexture", number_texture(3)}};
  coat["clearcoatNormalTexture"] = {{"index", 1}, {"scale", 0.5}};
  Json leaf{{"name", "leaf"}, {"alphaMode", "MASK"}, {"alphaCutoff", 0.25}, {"doubleSided", true}};
  leaf["pbrMetallicRoughness"] = {{"baseColorTexture", number_texture(1)}, {"metallicFactor", 0}};
  leaf["occlusionTexture"] = {{"index", 2}, {"strength", 0.5}};
  leaf["emissiveFactor"] = {1, 0.5, 0};
  leaf["extensions"] = {{"KHR_materials_clearcoat", coat},
                        {"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}};
  leaf["extras"] = {{"index", 7}, {"texture", number_texture(9)}};
  scene.json["materials"] = Json::array({{{"normalTexture", number_texture(0)}}, leaf});
  scene.json["textures"] = {{{"source", 0}},
                            {{"sampler", 2}, {"source", 3}, {"name", "clamped"}},
                            {{"sampler", 0}, {"source", 2}},
                            {{"sampler", 2}, {"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}}};
  scene.json["samplers"] = {{{"wrapS", 33648}}, Json::object(), {{"magFilter", 9728}, {"wrapS", 33071}}};
  const auto image = [&](const std::string& bytes, const char* type) {
    return Json{{"bufferView", scene.add_view(bytes)}, {"mimeType", type}, {"extras", bytes.size()}};
  };
  scene.json["images"] = {image(test::png_bytes("unused"), "image/png"), image("RIFF1234WEBP", "image/webp"),
                          image(test::png_bytes("dark"), "image/png"), image(test::jpeg_bytes("leaf"), "image/jpeg")};
  scene.json["extensionsUsed"] = {"KHR_materials_clearcoat", "KHR_materials_emissive_strength", "EXT_texture_webp",
                                  "KHR_materials_ior"};
  scene.json["extensionsRequired"] = {"EXT_texture_webp"};
  return scene;
}

/// Returns a material with the objects of its textures in place of their numbers, with those of samplers and the bytes
/// of images.
Json resolved(const std::string& glb, Json value) {
  const Json json = test::json_of_glb(glb);
  const auto bytes_of = [&](const Json& number) {
    Json image = json["images"].at(number.get<size_t>());
    const std::string bytes = test::view_of_glb(glb, image["bufferView"]);
    image.erase("bufferView");
    image["bytes"] = std::vector<int>(bytes.begin(), bytes.end());
    return image;
  };
  for (auto& [key, inner] : value.items()) {
    if (key == "extras" || !inner.is_object()) continue;
    inner = resolved(glb, inner);
    if (!inner.contains("index")) continue;
    Json texture = json["textures"].at(inner["index"].get<size_t>());
    if (texture.contains("sampler")) texture["sampler"] = json["samplers"].at(texture["sampler"].get<size_t>());
    if (texture.contains("source")) texture["source"] = bytes_of(texture["source"]);
    if (texture.contains("extensions"))
      for (auto& extension : texture["extensions"]) extension["source"] = bytes_of(extension["source"]);
    inner["index"] = std::move(texture);
  }
  return value;
}

Packed pack_scene(const GltfScene& scene, const PackOptions& options) {
  return pack(gltf::flatten_with_materials(scene.glb(), {}), options);
}

void expect_leaf(const std::string& glb, const GltfScene& original) {
  const Json json = test::json_of_glb(glb);
  ASSERT_EQ(json["materials"].size(), 1U);
  EXPECT_EQ(resolved(glb, json["materials"][0]), resolved(original.glb(), original.json["materials"][1]));
  EXPECT_EQ(json["textures"].size(), 3U);
  EXPECT_EQ(json["samplers"].size(), 2U);
  EXPECT_EQ(json["images"].size(), 3U);
  const auto lists = [&](const char* list, const char* name) {
    return json.contains(list) && std::ranges::count(json[list], Json(name)) == 1;
  };
  for (const char* name : {"KHR_materials_clearcoat", "KHR_materials_emissive_strength", "EXT_texture_webp"})
    EXPECT_TRUE(lists("extensionsUsed", name)) << name;
  EXPECT_TRUE(lists("extensionsRequired", "EXT_texture_webp"));
  EXPECT_FALSE(lists("extensionsRequired", "KHR_materials_clearcoat"));
  EXPECT_FALSE(lists("extensionsUsed", "KHR_materials_ior"));
}

TEST(PackedMaterials, PackedModelsKeepMaterialsOfScenesWhole) {
  const GltfScene scene = scene_of_ball(4);
  const Packed packed = pack_scene(scene, {.rms = 3e-3, .face_limit = 20'000});
  ASSERT_TRUE(packed.model) << packed.reason;
  expect_leaf(packed.glb, scene);
  const size_t bytes =
      std::string("RIFF1234WEBP").size() + test::png_bytes("dark").size() + test::jpeg_bytes("leaf").size();
  EXPECT_EQ(packed.image_bytes, bytes);
  gltf::MaterialMesh fine = gltf::flatten_with_materials(packed.glb, {});
  fine.mesh = decode_packed(read_packed(packed.glb));
  fine.materials.of_triangle.assign(fine.mesh.triangles.size(), 0);
  expect_leaf(gltf::scene_of_mesh(fine.mesh, fine.materials), scene);
}

TEST(PackedMaterials, PlainDracoFilesKeepMaterialsOfScenesWhole) {
  const GltfScene scene = scene_of_ball(0);
  const Packed packed = pack_scene(scene, {.rms = 1e-3, .face_limit = 500});
  ASSERT_FALSE(packed.model);
  expect_leaf(packed.glb, scene);
}

TEST(PackedMaterials, SimplifiedFilesKeepTheMaterial) {
  gltf::MaterialMesh box{.mesh = {}};
  static_cast<TriangleMesh&>(box.mesh) = test::box({21, 21, 21}, {1, 2, 3});
  box.materials.materials = {{.name = "red", .base_color = {1, 0, 0, 1}}};
  box.materials.of_triangle.assign(box.mesh.triangles.size(), 0);
  const Packed packed = pack(box, {.rms = 4e-2, .simplifies = true});
  ASSERT_FALSE(packed.model);
  ASSERT_TRUE(packed.simplified);
  ASSERT_EQ(packed.simplified->bytes, packed.glb.size());
  const gltf::Materials read = gltf::flatten_with_materials(packed.glb, {}).materials;
  EXPECT_EQ(read.materials, box.materials.materials);
  EXPECT_EQ(read.of_triangle, std::vector<uint32_t>(packed.simplified->faces, 0));
}

TEST(PackedMaterials, TexturesAreDroppedWithoutCoordinates) {
  GltfScene scene = scene_of_ball(0);
  scene.primitive()["attributes"].erase("TEXCOORD_0");
  const Packed packed = pack_scene(scene, {.rms = 1e-3, .face_limit = 500});
  const Json json = test::json_of_glb(packed.glb);
  for (const char* array : {"textures", "samplers", "images"}) EXPECT_FALSE(json.contains(array)) << array;
  EXPECT_EQ(packed.image_bytes, 0U);
  EXPECT_EQ(json["materials"][0]["alphaCutoff"], 0.25);
  EXPECT_EQ(json["materials"][0]["extensions"]["KHR_materials_clearcoat"], (Json{{"clearcoatFactor", 0.75}}));
  EXPECT_FALSE(json["materials"][0].contains("occlusionTexture"));
}

TEST(PackedMaterials, ImagesWithoutBytesAreDroppedWithTheirTextures) {
  GltfScene scene = scene_of_ball(0);
  scene.json["images"][2] = {{"uri", "lost.png"}};
  const Packed packed = pack_scene(scene, {.rms = 1e-3, .face_limit = 500});
  const Json json = test::json_of_glb(packed.glb);
  EXPECT_FALSE(json["materials"][0].contains("occlusionTexture"));
  EXPECT_EQ(json["textures"].size(), 2U);
  EXPECT_EQ(json["images"].size(), 2U);
}

}  // namespace
}  // namespace papilio::proto::detail
