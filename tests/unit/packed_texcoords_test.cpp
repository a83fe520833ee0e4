#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>

#include "proto/detail/decode_packed.h"
#include "proto/detail/pack.h"
#include "proto/detail/packed_reader.h"
#include "proto/detail/packed_texcoords.h"
#include "proto/detail/used_materials.h"
#include "proto/gltf/container.h"
#include "proto/gltf/flattening.h"
#include "proto/problem.h"
#include "tests/support/charts.h"
#include "tests/support/gltf_scene.h"
#include "tests/support/packed_model.h"
#include "tests/support/shapes.h"

// Texture coordinates and materials of packed models.

namespace papilio::proto::detail {
namespace {

using test::refusal_of;
using TexturedJson = test::GltfScene::Json;

/// A cube of six charts with texture coordinates as its only attribute.
FormattedMesh textured_cube() {
  FormattedMesh cube = test::charted_cube();
  cube.attributes.erase(cube.attributes.begin());
  cube.format.attributes.erase(cube.format.attributes.begin());
  return cube;
}

test::PackedFixture textured_fixture() { return test::packed_fixture(textured_cube(), 2); }

gltf::Materials one_material() {
  gltf::Materials made;
  made.images.push_back({.name = "bark", .media_type = "image/png", .bytes = "the image's bytes"});
  made.materials.push_back({.name = "tree", .roughness = 0.5});
  made.materials[0].image(gltf::ImageUse::base_color) = 0;
  return made;
}

/// Bytes of the table, and the offsets of the step and size of the first level's texture coordinates.
constexpr size_t table_bytes = 18 + 2 * 24;
constexpr size_t step_at = 34;
constexpr size_t size_at = 38;

/// Returns the code with which the model is refused after a 32-bit number of its table is changed.
std::string refusal_with(const test::PackedFixture& made, size_t at, uint32_t number) {
  std::string glb = made.glb;
  const size_t begin = glb.size() - test::binary_of_glb(glb).size() + made.base_stream.size() + at;
  for (unsigned i = 0; i < 4; ++i) glb[begin + i] = static_cast<char>(number >> (8 * i) & 0xFF);
  return refusal_of(glb, [](TexturedJson&) {});
}

TEST(PackedTexcoords, TexcoordsRoundTripExactly) {
  const test::PackedFixture made = textured_fixture();
  const PackedModel model = read_packed(made.glb);
  EXPECT_EQ(model.base, made.detail.base);
  ASSERT_EQ(model.base.triangles.attributes.size(), 1U);
  EXPECT_EQ(model.base.triangles.positions.size(), 24U) << "three points at each corner";
  ASSERT_EQ(model.levels.size(), 2U);
  for (size_t l = 0; l < 2; ++l) {
    EXPECT_EQ(model.levels[l].stream.bytes, made.detail.levels[l].bytes);
    EXPECT_EQ(model.levels[l].stream.texcoords.bytes, made.detail.levels[l].texcoords.bytes);
    EXPECT_EQ(model.levels[l].stream.texcoords.step, made.detail.levels[l].texcoords.step);
  }
  EXPECT_EQ(model.levels[0].vertices, 18U) << "seams do not open the surface";
}

TEST(PackedTexcoords, AnyViewerReadsTheTexcoordsOfTheBase) {
  const FormattedMesh base = gltf::flatten_scene(textured_fixture().glb, {});
  ASSERT_EQ(base.format.attributes.size(), 1U);
  EXPECT_EQ(base.format.attributes[0].kind, AttributeKind::tex_coord);
  EXPECT_EQ(base.positions.size(), 24U);
}

TEST(PackedTexcoords, VerticalAxisIsFlippedInPackingAndDecoding) {
  const FormattedMesh cube = textured_cube();
  const std::optional<Attribute> taken = texcoords_to_pack(cube);
  ASSERT_TRUE(taken);
  for (size_t i = 0; i < taken->values.size(); ++i) {
    const double value = cube.attributes[0].values[i];
    EXPECT_EQ(taken->values[i], i % 2 == 0 ? value : 1 - value);
  }
  PackedModel model;
  model.base.triangles = {cube.positions, cube.triangles, {*taken}};
  const FormattedMesh back = decode_packed(model);
  EXPECT_EQ(back.format.attributes.at(0).kind, AttributeKind::tex_coord);
  for (const Attribute& texcoords : back.attributes)
    for (const double value : texcoords.values) EXPECT_TRUE(value == std::round(value) && value >= 0);
}

TEST(PackedTexcoords, LevelWithTruncatedTexcoordsIsIncomplete) {
  const test::PackedFixture made = textured_fixture();
  const size_t end = made.glb.size() - made.glb.size() % 4;
  const size_t levels_end =
      end - (made.base_stream.size() + table_bytes + 160 + 3) / 4 * 4 + made.base_stream.size() + table_bytes + 160;
  EXPECT_EQ(read_packed(made.glb.substr(0, levels_end), {.may_be_cut = true}).levels.size(), 2U);
  EXPECT_EQ(read_packed(made.glb.substr(0, levels_end - 1), {.may_be_cut = true}).levels.size(), 1U);
  EXPECT_EQ(read_packed(made.glb.substr(0, levels_end - 80), {.may_be_cut = true}).levels.size(), 1U);
  EXPECT_EQ(read_packed(made.glb.substr(0, levels_end - 81), {.may_be_cut = true}).levels.size(), 0U);
}

TEST(PackedTexcoords, LevelWithoutTexcoordsIsRead) {
  test::PackedFixture made = textured_fixture();
  made.detail.levels[0].texcoords = {};
  const PackedModel model = read_packed(write_packed(made.detail, {made.base_stream}));
  EXPECT_EQ(model.levels.at(0).stream.texcoords.step, 0);
  EXPECT_EQ(model.levels.at(1).stream.texcoords.step, made.detail.levels[1].texcoords.step);
}

TEST(PackedTexcoords, InvalidTexcoordStreamsAreRefused) {
  const test::PackedFixture made = textured_fixture();
  const std::string glb = made.glb;
  const auto expect = [&](const char* code, const std::function<void(TexturedJson&)>& change) {
    EXPECT_EQ(refusal_of(glb, change), code);
  };
  expect("read", [](TexturedJson&) {});
  EXPECT_EQ(refusal_with(made, step_at, std::bit_cast<uint32_t>(0.25F)), "read");
  for (const float step : {0.0F, -1.0F, 1.1e18F})
    EXPECT_EQ(refusal_with(made, step_at, std::bit_cast<uint32_t>(step)), "mesh_not_gltf") << step;
  EXPECT_EQ(refusal_with(made, size_at, 39), "mesh_not_gltf");
  expect("mesh_not_gltf",
         [](TexturedJson& json) { json["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0"); });
  expect("mesh_unsupported",
         [](TexturedJson& json) { json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 0; });
  test::PackedFixture plain = test::packed_fixture(test::cube(), 1);
  plain.detail.levels[0].texcoords.step = 0.1F;
  EXPECT_EQ(refusal_of(write_packed(plain.detail, {plain.base_stream}), [](TexturedJson&) {}), "mesh_not_gltf");
  EXPECT_EQ(refusal_of(plain.glb,
                       [](TexturedJson& json) { json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 0; }),
            "mesh_unsupported");
}

TEST(PackedMaterial, UnusedMaterialsAndImagesAreRemoved) {
  gltf::Materials several = one_material();
  several.materials.push_back({.name = "other"});
  several.images.insert(several.images.begin(), {.name = "unused", .bytes = "x"});
  several.materials[0].image(gltf::ImageUse::base_color) = 1;
  several.materials[0].image(gltf::ImageUse::emissive) = 1;
  several.of_triangle = {0, 0, 0};
  const gltf::Materials only = used_materials(several);
  gltf::Materials expected = one_material();
  expected.materials[0].image(gltf::ImageUse::emissive) = 0;
  EXPECT_EQ(only.materials, expected.materials);
  EXPECT_EQ(only.images, expected.images);
  several.of_triangle = {1, none, 1};
  const gltf::Materials other = used_materials(several);
  ASSERT_EQ(other.materials.size(), 1U);
  EXPECT_EQ(other.materials[0].name, "other");
  EXPECT_TRUE(other.images.empty());
  EXPECT_EQ(other.of_triangle, (std::vector<uint32_t>{0, none, 0}));
  several.of_triangle = {none, none};
  EXPECT_TRUE(used_materials(several).of_triangle.empty());
  EXPECT_TRUE(used_materials({}).empty());
}

TEST(PackedMaterial, ImagesAreStoredUnchangedAfterTheLevels) {
  const test::PackedFixture made = textured_fixture();
  const std::string glb = write_packed(made.detail, {made.base_stream}, one_material());
  const gltf::MaterialMesh read = gltf::flatten_with_materials(glb, {});
  EXPECT_EQ(read.materials.images, one_material().images);
  EXPECT_EQ(read.materials.materials, one_material().materials);
  EXPECT_EQ(read.materials.of_triangle, std::vector<uint32_t>(12, 0));
  EXPECT_EQ(read_packed(glb).levels.size(), 2U);
  const std::string binary = test::binary_of_glb(glb);
  EXPECT_EQ(binary.find("the image's bytes"), made.base_stream.size() + table_bytes + 160);
}

TEST(PackedMaterial, PlainDracoFilesKeepTheMaterial) {
  const FormattedMesh cube = textured_cube();
  gltf::MaterialMesh model{.mesh = cube, .materials = one_material()};
  model.materials.of_triangle.assign(cube.triangles.size(), 0);
  const Packed packed = pack(model, {.rms = 1e-2, .face_limit = 500});
  ASSERT_FALSE(packed.model);
  EXPECT_EQ(packed.image_bytes, 17U);
  const std::optional<PlainModel> read = read_plain_draco(packed.glb, {});
  ASSERT_TRUE(read);
  EXPECT_EQ(read->mesh.positions.size(), 24U);
  for (const double value : read->mesh.attributes.at(0).values) EXPECT_NEAR(value, std::round(value), 11.0 / (1 << 14));
  const gltf::MaterialMesh scene = gltf::flatten_with_materials(packed.glb, {});
  EXPECT_EQ(scene.materials.images, one_material().images);
}

}  // namespace
}  // namespace papilio::proto::detail
