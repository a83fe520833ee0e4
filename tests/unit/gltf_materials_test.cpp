#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "proto/gltf/data_uri.h"
#include "proto/gltf/flattening.h"
#include "proto/gltf/material_reader.h"
#include "proto/gltf/material_writer.h"
#include "proto/problem.h"
#include "tests/support/gltf_refinement.h"
#include "tests/support/gltf_scene.h"
#include "tests/support/images.h"
#include "tests/support/shapes.h"

namespace papilio::proto::gltf {
namespace {

using test::GltfScene;
using Json = GltfScene::Json;

Materials two_materials(size_t triangles) {
  Materials materials;
  materials.images = {{"wood", "image/png", test::png_bytes("wood"), ""},
                      {"bumps", "image/jpeg", test::jpeg_bytes("bumps"), ""}};
  Material first{.name = "first",
                 .base_color = {0.1, 0.2, 0.3, 0.4},
                 .is_blended = true,
                 .emissive = {0.5, 8, 2},
                 .metallic = 0.25,
                 .roughness = 0.75};
  first.image(ImageUse::base_color) = 0;
  first.image(ImageUse::emissive) = 0;
  first.image(ImageUse::normal) = 1;
  first.image(ImageUse::metallic_roughness) = 1;
  materials.materials = {first, {.name = "second"}};
  for (size_t t = 0; t < triangles; ++t)
    materials.of_triangle.push_back(t % 3 == 2 ? none : static_cast<uint32_t>(t % 3));
  return materials;
}

FormattedMesh with_coordinates(const TriangleMesh& shape) {
  FormattedMesh mesh{shape, {}};
  Attribute& attribute = mesh.attributes.emplace_back();
  attribute.components = 2;
  for (size_t i = 0; i < 2 * shape.positions.size(); ++i) attribute.values.push_back(static_cast<double>(i) / 64);
  mesh.format.attributes = {
      {.kind = AttributeKind::tex_coord, .type = ValueType::float32, .normalized = false, .id = 1}};
  return mesh;
}

TEST(GltfMaterials, MaterialsRoundTripThroughASceneOfOneMesh) {
  const FormattedMesh mesh = with_coordinates(test::icosahedron());
  const Materials materials = two_materials(mesh.triangles.size());
  const std::string glb = scene_of_mesh(mesh, materials);
  const MaterialMesh back = flatten_with_materials(glb, {});
  ASSERT_EQ(back.materials.materials.size(), 2U);
  for (size_t m = 0; m < 2; ++m) {
    const Material& before = materials.materials[m];
    const Material& after = back.materials.materials[m];
    EXPECT_EQ(after.name, before.name);
    EXPECT_EQ(after.base_color, before.base_color);
    EXPECT_EQ(after.is_blended, before.is_blended);
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(after.emissive[c], before.emissive[c], 1e-12);
    EXPECT_EQ(after.metallic, before.metallic);
    EXPECT_EQ(after.roughness, before.roughness);
    for (size_t use = 0; use < image_use_count; ++use) {
      ASSERT_EQ(after.images[use].has_value(), before.images[use].has_value());
      if (!after.images[use]) continue;
      EXPECT_EQ(back.materials.images[*after.images[use]], materials.images[*before.images[use]]);
    }
  }
  std::array<size_t, 3> counts{};
  for (const uint32_t material : back.materials.of_triangle) ++counts.at(material == none ? 2 : material);
  EXPECT_EQ(counts, (std::array<size_t, 3>{7, 7, 6}));
  EXPECT_EQ(back.mesh.positions, mesh.positions);
  EXPECT_EQ(back.mesh.attributes[0].values, mesh.attributes[0].values);
}

TEST(GltfMaterials, PrimitivesShareTheirVertices) {
  const FormattedMesh mesh = with_coordinates(test::icosahedron());
  const Json json = test::json_of_glb(scene_of_mesh(mesh, two_materials(mesh.triangles.size())));
  const Json& primitives = json["meshes"][0]["primitives"];
  ASSERT_EQ(primitives.size(), 3U);
  EXPECT_FALSE(primitives[0].contains("material"));
  EXPECT_EQ(primitives[1]["material"], 0);
  EXPECT_EQ(primitives[2]["material"], 1);
  for (const Json& primitive : primitives) EXPECT_EQ(primitive["attributes"], primitives[0]["attributes"]);
  EXPECT_EQ(json["images"].size(), 2U);
  EXPECT_EQ(json["extensionsUsed"], Json::array({"KHR_materials_emissive_strength"}));
  EXPECT_LE(json["materials"][0]["emissiveFactor"][1], 1);
}

TEST(GltfMaterials, BordersStayClosedWhenTheSceneIsRefined) {
  FormattedMesh mesh{test::icosahedron(), {}};
  const std::string glb = scene_of_mesh(mesh, two_materials(mesh.triangles.size()));
  const std::string fine = test::refined(glb, {{"levels", "2"}}).bytes;
  const MaterialMesh flat = flatten_with_materials(fine, {});
  EXPECT_EQ(flat.mesh.triangles.size(), 320U);
  BuildReport found;
  (void)build_mesh(flat.mesh, &found);
  EXPECT_EQ(found.boundary_edges, 0U);
  EXPECT_EQ(flat.materials.materials[0].base_color, (std::array<double, 4>{0.1, 0.2, 0.3, 0.4}));
}

TEST(GltfMaterials, ImagesWithoutCoordinatesAreOmitted) {
  const FormattedMesh mesh{test::icosahedron(), {}};
  const Json json = test::json_of_glb(scene_of_mesh(mesh, two_materials(mesh.triangles.size())));
  EXPECT_FALSE(json.contains("images"));
  EXPECT_FALSE(json.contains("textures"));
  EXPECT_EQ(json["materials"].size(), 2U);
}

TEST(GltfMaterials, NamesThatAreNotUtf8AreReadAsLatin1) {
  Materials materials{.materials = {{.name = "Terraind\xe4k"}, {.name = "Terrain\xc3\xa4"}}};
  materials.of_triangle.assign(20, 0);
  const Json json = test::json_of_glb(scene_of_mesh({test::icosahedron(), {}}, materials));
  EXPECT_EQ(json["materials"][0]["name"], "Terraind\xc3\xa4k");
  EXPECT_EQ(json["materials"][1]["name"], "Terrain\xc3\xa4");
}

/// An icosahedron with texture coordinates (0.25, 0.5) in the first set and (0.5, 0.75) in the second, and one texture.
GltfScene textured_scene() {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  std::vector<float> first;
  std::vector<float> second;
  for (int i = 0; i < 12; ++i) {
    first.insert(first.end(), {0.25F, 0.5F});
    second.insert(second.end(), {0.5F, 0.75F});
  }
  scene.primitive()["attributes"]["TEXCOORD_0"] = scene.add_accessor(first, "VEC2");
  scene.primitive()["attributes"]["TEXCOORD_1"] = scene.add_accessor(second, "VEC2");
  scene.primitive()["material"] = 0;
  scene.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  scene.json["textures"] = {{{"source", 0}}};
  scene.json["images"] = {{{"uri", encode_data_uri("pixels", "data:image/png;base64,")}}};
  return scene;
}

/// Returns the texture coordinates of the first point, with v downwards as in glTF.
std::array<double, 2> coordinates_of(const GltfScene& scene) {
  const MaterialMesh flat = flatten_with_materials(scene.glb(), {});
  const std::vector<double>& values = flat.mesh.attributes.at(0).values;
  return {values.at(0), 1 - values.at(1)};
}

TEST(GltfMaterials, CoordinatesIncludeTheTextureTransform) {
  GltfScene scene = textured_scene();
  EXPECT_EQ(coordinates_of(scene), (std::array<double, 2>{0.25, 0.5}));
  Json& texture = scene.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  texture["texCoord"] = 1;
  EXPECT_EQ(coordinates_of(scene), (std::array<double, 2>{0.5, 0.75}));
  texture["extensions"]["KHR_texture_transform"] = {{"texCoord", 0}, {"scale", {2, 4}}, {"offset", {1, -1}}};
  EXPECT_EQ(coordinates_of(scene), (std::array<double, 2>{1.5, 1}));
  texture["extensions"]["KHR_texture_transform"] = {{"texCoord", 0}, {"rotation", 1.5707963267948966}};
  EXPECT_NEAR(coordinates_of(scene)[0], 0.5, 1e-9);
  EXPECT_NEAR(coordinates_of(scene)[1], -0.25, 1e-9);
}

TEST(GltfMaterials, SharedVerticesAreSplitBetweenTextureMaps) {
  GltfScene scene = textured_scene();
  Json second = scene.primitive();
  second["material"] = 1;
  scene.json["meshes"][0]["primitives"].push_back(second);
  scene.json["materials"].push_back(scene.json["materials"][0]);
  EXPECT_EQ(flatten_with_materials(scene.glb(), {}).mesh.positions.size(), 12U);
  scene.json["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 1;
  const MaterialMesh flat = flatten_with_materials(scene.glb(), {});
  EXPECT_EQ(flat.mesh.positions.size(), 24U);
  EXPECT_EQ(flat.mesh.triangles.size(), 40U);
  EXPECT_EQ(flat.materials.images.size(), 1U);
  const uint32_t last = flat.mesh.triangles.back()[0];
  EXPECT_EQ(flat.mesh.attributes[0].values[2 * last], 0.5);
  EXPECT_EQ(flatten_scene(scene.glb(), {}).positions.size(), 12U);
}

TEST(GltfMaterials, AlphaCountsUnlessTheMaterialIsOpaque) {
  GltfScene scene = textured_scene();
  const auto is_blended = [&] { return flatten_with_materials(scene.glb(), {}).materials.materials[0].is_blended; };
  EXPECT_FALSE(is_blended());
  for (const auto& [mode, expected] : {std::pair{"OPAQUE", false}, {"MASK", true}, {"BLEND", true}}) {
    scene.json["materials"][0]["alphaMode"] = mode;
    EXPECT_EQ(is_blended(), expected) << mode;
  }
}

TEST(GltfMaterials, DamagedMaterialsAreRefused) {
  const auto refuse = [](const std::function<void(Json&)>& damage) {
    GltfScene scene = textured_scene();
    damage(scene.json);
    EXPECT_THROW((void)flatten_with_materials(scene.glb(), {}), Problem);
  };
  refuse([](Json& json) { json["materials"] = Json::array(); });
  refuse([](Json& json) { json["textures"] = Json::array(); });
  refuse([](Json& json) { json["images"] = Json::array(); });
  refuse([](Json& json) { json["images"][0]["uri"] = "data:image/png;base64,?"; });
  refuse([](Json& json) { json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 2}; });
  refuse([](Json& json) { json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = "shiny"; });
  refuse([](Json& json) { json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"].erase("index"); });
  refuse([](Json& json) { json["images"][0] = {{"bufferView", 99}}; });
}

}  // namespace
}  // namespace papilio::proto::gltf
