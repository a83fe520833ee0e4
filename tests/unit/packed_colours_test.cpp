#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "proto/detail/decode_packed.h"
#include "proto/detail/pack.h"
#include "proto/detail/packed_reader.h"
#include "proto/detail/packed_texcoords.h"
#include "proto/detail/plain_draco.h"
#include "proto/draco_reader.h"
#include "proto/gltf/flattening.h"
#include "proto/problem.h"
#include "proto/refinement.h"
#include "tests/support/gltf_refinement.h"
#include "tests/support/packed_model.h"
#include "tests/support/shapes.h"

// Colours of packed models.

namespace papilio::proto::detail {
namespace {

using ColourJson = test::GltfScene::Json;

/// Colours of bytes, red along z and green along x.
FormattedMesh coloured(const TriangleMesh& plain, uint32_t components = 3) {
  FormattedMesh mesh;
  static_cast<TriangleMesh&>(mesh) = plain;
  Attribute colours{.components = components, .values = {}};
  for (const Vec3f p : plain.positions) {
    const std::array<double, 4> colour{std::round(128 + 90 * double{p.z}), std::round(128 + 70 * double{p.x}), 30, 255};
    colours.values.insert(colours.values.end(), colour.begin(), colour.begin() + components);
  }
  mesh.attributes.push_back(std::move(colours));
  mesh.format.attributes.push_back(
      {.kind = AttributeKind::color, .type = ValueType::uint8, .normalized = true, .id = 1});
  return mesh;
}

/// Returns the largest difference of colours, in bytes, from those of `coloured` at the points. `number`: of the
/// attribute.
double largest_error(const FormattedMesh& mesh, size_t number = 0) {
  const Attribute& colours = mesh.attributes.at(number);
  double largest = 0;
  for (size_t p = 0; p < mesh.positions.size(); ++p) {
    const Vec3f at = mesh.positions[p];
    const std::array<double, 3> wanted{128 + 90 * double{at.z}, 128 + 70 * double{at.x}, 30};
    for (size_t c = 0; c < 3; ++c)
      largest = std::max(largest, std::abs(colours.values[p * colours.components + c] - wanted[c]));
  }
  return largest;
}

constexpr double wanted_rms = 2e-3;
/// Bound: three quarters of the default step of 4, the rounding of bytes, and the error of positions.
constexpr double largest_miss = 6;

std::string packed_coloured_torus() {
  const gltf::MaterialMesh torus{.mesh = coloured(test::torus(64, 32))};
  Packed packed = pack(torus, {.rms = wanted_rms, .face_limit = 20'000});
  EXPECT_TRUE(packed.model) << packed.reason;
  return std::move(packed.glb);
}

TEST(PackedColours, ColoursRoundTripApproximatelyInBytes) {
  const PackedModel model = read_packed(packed_coloured_torus());
  EXPECT_TRUE(model.has_colours());
  EXPECT_FALSE(model.has_texcoords());
  const FormattedMesh fine = decode_packed(model);
  ASSERT_EQ(fine.attributes.size(), 1U);
  EXPECT_EQ(fine.format.attributes[0].kind, AttributeKind::color);
  EXPECT_EQ(fine.format.attributes[0].type, ValueType::uint8);
  for (const double value : fine.attributes[0].values)
    EXPECT_TRUE(value == std::round(value) && value >= 0 && value < 256);
  EXPECT_LT(largest_error(fine), largest_miss);
}

TEST(PackedColours, AnyViewerReadsTheColoursOfTheBase) {
  const std::string glb = packed_coloured_torus();
  const ColourJson json = test::json_of_glb(glb);
  const size_t number = json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"];
  EXPECT_EQ(json["accessors"][number]["componentType"], 5121);
  EXPECT_EQ(json["accessors"][number]["normalized"], true);
  EXPECT_LT(largest_error(gltf::flatten_scene(glb, {})), 1);
}

TEST(PackedColours, RefinedScenesAndDracoAnswersHaveTheDecodersColours) {
  const std::string glb = packed_coloured_torus();
  const PackedModel model = read_packed(glb);
  const auto colours_at = [](const FormattedMesh& mesh) {
    std::map<std::array<float, 3>, std::array<double, 3>> found;
    const Attribute& colours = mesh.attributes.at(0);
    for (size_t p = 0; p < mesh.positions.size(); ++p) {
      const double* value = &colours.values[p * colours.components];
      found[{mesh.positions[p].x, mesh.positions[p].y, mesh.positions[p].z}] = {
          std::round(value[0]), std::round(value[1]), std::round(value[2])};
    }
    return found;
  };
  const auto expected = colours_at(decode_packed(model));
  const std::string levels = std::to_string(model.levels.size());
  const std::string scene = test::refined(glb, {{"levels", levels}, {"output.compress", "none"}}).bytes;
  EXPECT_EQ(colours_at(gltf::flatten_scene(scene, {})), expected);
  const FormattedMesh answer = read_draco(Refinement(glb, parse_query({{"levels", levels}}), {}).run().bytes, {});
  EXPECT_EQ(answer.positions.size(), expected.size());
  EXPECT_LT(largest_error(answer), largest_miss);
}

TEST(PackedColours, PlainDracoFilesKeepColours) {
  const gltf::MaterialMesh cube{.mesh = coloured(test::cube())};
  const Packed packed = pack(cube, {.rms = 1e-2, .face_limit = 500});
  ASSERT_FALSE(packed.model);
  const std::optional<PlainModel> read = read_plain_draco(packed.glb, {});
  ASSERT_TRUE(read);
  EXPECT_LT(largest_error(read->mesh), 1);
}

TEST(PackedColours, ColoursArePackedAsBytesWithoutOpacity) {
  FormattedMesh mesh = coloured(test::cube(), 4);
  EXPECT_FALSE(has_opacity(mesh));
  std::optional<Attribute> taken = colours_to_pack(mesh);
  ASSERT_TRUE(taken);
  EXPECT_EQ(*taken, coloured(test::cube()).attributes[0]);
  mesh.attributes[0].values[7] = 254;
  EXPECT_TRUE(has_opacity(mesh));
  mesh.format.attributes[0].type = ValueType::float32;
  for (double& value : mesh.attributes[0].values) value /= 255;
  taken = colours_to_pack(mesh);
  ASSERT_TRUE(taken);
  EXPECT_EQ(*taken, coloured(test::cube()).attributes[0]);
  mesh.attributes[0].values[0] = 7;
  mesh.attributes[0].values[1] = -1;
  taken = colours_to_pack(mesh);
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->values[0], 255);
  EXPECT_EQ(taken->values[1], 0);
  EXPECT_FALSE(colours_to_pack(FormattedMesh{}));
}

TEST(PackedColours, MissingAndUnknownAttributesAreRefused) {
  const std::string glb = test::packed_fixture(coloured(test::icosahedron()), 2).glb;
  const auto expect = [&](const char* code, const std::function<void(ColourJson & primitive)>& change) {
    EXPECT_EQ(test::refusal_of(glb, [&](ColourJson& json) { change(json["meshes"][0]["primitives"][0]); }), code);
  };
  expect("read", [](ColourJson&) {});
  expect("mesh_not_gltf", [](ColourJson& primitive) { primitive["attributes"].erase("COLOR_0"); });
  expect("mesh_unsupported", [](ColourJson& primitive) { primitive["attributes"]["COLOR_1"] = 0; });
  expect("mesh_unsupported", [](ColourJson& primitive) { primitive["attributes"]["TEXCOORD_0"] = 0; });
  expect("mesh_unsupported", [](ColourJson& primitive) {
    primitive["attributes"]["TEXCOORD_0"] = primitive["attributes"]["COLOR_0"];
    primitive["attributes"].erase("COLOR_0");
  });
}

}  // namespace
}  // namespace papilio::proto::detail
