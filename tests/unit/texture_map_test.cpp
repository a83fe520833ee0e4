#include "proto/gltf/texture_map.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "proto/gltf/extensions.h"
#include "proto/gltf/flattening.h"
#include "tests/support/gltf_scene.h"
#include "tests/support/shapes.h"

// Textures of one material with different maps: their coordinates are those of the first one's map.

namespace papilio::proto::gltf {
namespace {

using test::GltfScene;

Json transform(double offset, double rotation, std::array<double, 2> scale) {
  return {{"offset", {offset, 1 - offset}}, {"rotation", rotation}, {"scale", scale}};
}

Json info_with(const Json& transform) {
  return {{"index", 0}, {"extensions", {{texture_transform_extension, transform}}}};
}

TEST(TextureMap, RewrittenMapsGiveTheSameCoordinates) {
  const std::vector<Json> transforms{Json::object(), transform(0.25, 0, {2, 3}), transform(0, 0.5, {2, 2}),
                                     transform(-1, -2, {0.5, 0.5}), transform(3, 0.5, {4, 4})};
  for (const Json& first : transforms)
    for (const Json& second : transforms) {
      const TextureMap done = read_texture_map(info_with(first), "");
      const TextureMap map = read_texture_map(info_with(second), "");
      Json info = info_with(second);
      const bool is_sheared = done.rotation != 0 && map.scale[0] != map.scale[1];
      ASSERT_EQ(rewrite_texture_map(info, map, done), !is_sheared) << first << second;
      if (is_sheared) {
        EXPECT_EQ(info, info_with(second));
        continue;
      }
      const auto [u, v] = done.point(0.3, 0.7);
      const auto found = read_texture_map(info, "").point(u, v);
      const auto wanted = map.point(0.3, 0.7);
      EXPECT_NEAR(found[0], wanted[0], 1e-9) << first << second;
      EXPECT_NEAR(found[1], wanted[1], 1e-9) << first << second;
      EXPECT_EQ(info.contains("extensions"), first != second || first == Json::object());
    }
}

TEST(TextureMap, SetsBecomeTheFirst) {
  Json info{{"index", 0}, {"texCoord", 2U}, {"scale", 0.5}};
  const TextureMap map = read_texture_map(info, "");
  EXPECT_TRUE(rewrite_texture_map(info, map, map));
  EXPECT_EQ(info, (Json{{"index", 0}, {"scale", 0.5}}));
  info = info_with({{"texCoord", 1U}, {"rotation", 2}, {"extras", "kept"}});
  const TextureMap turned = read_texture_map(info, "");
  EXPECT_TRUE(rewrite_texture_map(info, turned, turned));
  EXPECT_EQ(info, info_with({{"extras", "kept"}}));
}

TEST(TextureMap, ScalesOfZeroHaveNoInverse) {
  Json info = info_with(transform(0, 0, {1, 1}));
  const TextureMap flat = read_texture_map(info_with(transform(0, 0, {0, 1})), "");
  EXPECT_FALSE(rewrite_texture_map(info, read_texture_map(info, ""), flat));
  EXPECT_TRUE(rewrite_texture_map(info, flat, flat));
}

/// An icosahedron with two sets of texture coordinates, and a material with an occlusion texture of the second.
GltfScene scene_of_two_sets() {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  for (const char* name : {"TEXCOORD_0", "TEXCOORD_1"})
    scene.primitive()["attributes"][name] = scene.add_accessor(std::vector<float>(24, 0.5F), "VEC2");
  scene.primitive()["material"] = 0;
  scene.json["materials"] = {{{"name", "oak"}, {"occlusionTexture", {{"index", 0}, {"texCoord", 1}}}}};
  scene.json["textures"] = {{{"source", 0}}};
  scene.json["images"] = {{{"uri", "data:image/png;base64,AAAA"}}};
  return scene;
}

TEST(TextureMap, TexturesOfAnotherSetAreLeftOutAndNamed) {
  GltfScene scene = scene_of_two_sets();
  const Materials only = flatten_with_materials(scene.glb(), {}).materials;
  EXPECT_TRUE(only.left_out.empty());
  EXPECT_EQ((*only.gltf)["materials"][0]["occlusionTexture"], (Json{{"index", 0}}));
  scene.json["materials"][0]["emissiveTexture"] = {{"index", 0}};
  const Materials both = flatten_with_materials(scene.glb(), {}).materials;
  ASSERT_EQ(both.left_out.size(), 1U);
  EXPECT_EQ(both.left_out[0],
            "occlusionTexture of the material \"oak\" is left out: it uses TEXCOORD_1, and only TEXCOORD_0 is kept, "
            "which its other textures use.");
  EXPECT_FALSE((*both.gltf)["materials"][0].contains("occlusionTexture"));
  EXPECT_TRUE((*both.gltf)["materials"][0].contains("emissiveTexture"));
}

TEST(TextureMap, ExtensionsWithDataOfTheDocumentAreLeftOutAndNamed) {
  GltfScene scene = scene_of_two_sets();
  scene.json["materials"][0]["extensions"] = {{"KHR_xmp_json_ld", {{"packet", 0}}},
                                              {"KHR_materials_unlit", Json::object()}};
  scene.json["extensions"] = {{"KHR_xmp_json_ld", {{"packets", Json::array()}}}};
  const Materials read = flatten_with_materials(scene.glb(), {}).materials;
  ASSERT_EQ(read.left_out.size(), 1U);
  EXPECT_TRUE(read.left_out[0].starts_with("KHR_xmp_json_ld of the material \"oak\" is left out"));
  EXPECT_EQ((*read.gltf)["materials"][0]["extensions"], (Json{{"KHR_materials_unlit", Json::object()}}));
}

}  // namespace
}  // namespace papilio::proto::gltf
