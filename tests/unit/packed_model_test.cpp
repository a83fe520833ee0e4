#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "proto/detail/pack.h"
#include "proto/detail/packed_reader.h"
#include "proto/draco_writer.h"
#include "proto/gltf/container.h"
#include "proto/gltf/flattening.h"
#include "proto/problem.h"
#include "tests/support/decoded_detail.h"
#include "tests/support/gltf_scene.h"
#include "tests/support/packed_model.h"
#include "tests/support/shapes.h"

namespace papilio::proto::detail {
namespace {

using test::packed_fixture;
using test::PackedFixture;
using Json = test::GltfScene::Json;

/// Returns the file with a changed document.
std::string changed(const std::string& glb, const std::function<void(Json&)>& change) {
  Json json = test::json_of_glb(glb);
  change(json);
  std::vector<gltf::Piece> pieces;
  pieces.push_back({{}, test::binary_of_glb(glb)});
  return gltf::write_glb(json.dump(), std::move(pieces), {});
}

Json& extension_in(Json& json) { return json["meshes"][0]["primitives"][0]["extensions"]["PAPILIO_detail"]; }

/// Returns the file with a changed extension PAPILIO_detail.
std::string with(const std::string& glb, const std::function<void(Json&)>& change) {
  return changed(glb, [&](Json& json) { change(extension_in(json)); });
}

/// First byte of the binary chunk's content.
size_t binary_begin(const std::string& glb) { return glb.size() - test::binary_of_glb(glb).size(); }

/// Byte of the table in the binary chunk: it follows the base.
size_t table_begin(const PackedFixture& made) { return made.base_stream.size(); }

/// Returns the file with other bytes in its table.
std::string with_table(const PackedFixture& made, size_t at, const std::string& bytes) {
  std::string glb = made.glb;
  glb.replace(binary_begin(glb) + table_begin(made) + at, bytes.size(), bytes);
  return glb;
}

std::string bytes_of(uint32_t number) {
  std::string bytes;
  for (unsigned i = 0; i < 4; ++i) bytes += static_cast<char>(number >> (8 * i) & 0xFF);
  return bytes;
}
std::string bytes_of(float number) { return bytes_of(std::bit_cast<uint32_t>(number)); }

/// Bytes of a table's members: offsets of the base's, and of the first two levels'.
constexpr size_t edges_at = 2;
constexpr size_t curve_bytes_at = 6;
constexpr std::array<size_t, 4> distances_at{10, 14, 22, 26};
constexpr std::array<size_t, 2> steps_at{18, 34};
constexpr size_t level_bytes_at = 30;

/// Returns the code with which a file is refused; "read" if it is read.
std::string refusal(const std::string& glb, const ReadOptions& options = {}) {
  try {
    (void)read_packed(glb, options);
    return "read";
  } catch (const Problem& problem) {
    EXPECT_GT(std::string(problem.what()).size(), 20U);
    return std::string(problem_kind(problem.code()).name);
  }
}

TEST(PackedModel, BaseAndStreamsRoundTripExactly) {
  const PackedFixture made = packed_fixture(test::torus(12, 8), 3);
  const PackedModel model = read_packed(made.glb);
  EXPECT_EQ(model.base, made.detail.base);
  EXPECT_EQ(model.base_bytes, made.base_stream.size());
  EXPECT_EQ(model.declared_levels, 3U);
  ASSERT_EQ(model.levels.size(), 3U);
  uint64_t edges = 3 * 12 * 8;
  uint64_t faces = 2 * 12 * 8;
  for (size_t l = 0; l < 3; ++l, edges *= 4) {
    EXPECT_EQ(model.levels[l].stream.step, made.detail.levels[l].step);
    EXPECT_EQ(model.levels[l].stream.bytes, made.detail.levels[l].bytes);
    EXPECT_EQ(model.levels[l].vertices, edges);
    EXPECT_EQ(model.levels[l].faces, faces *= 4);
  }
}

// Draco cuts the two faces apart, and repeats their points.
TEST(PackedModel, BaseWithFacesBackToBackIsRead) {
  TriangleMesh base = test::octahedron();
  const auto first = static_cast<uint32_t>(base.positions.size());
  base.positions.insert(base.positions.end(), {{5, 0, 0}, {5, 1, 0}, {5, 0, 1}});
  base.triangles.push_back({first, first + 1, first + 2});
  base.triangles.push_back({first, first + 2, first + 1});
  const PackedFixture made = packed_fixture(base, 1);
  ASSERT_EQ(made.detail.base.triangles.positions.size(), base.positions.size() + 3);
  const FormattedMesh fine = decode_packed(read_packed(made.glb));
  EXPECT_EQ(fine.triangles.size(), 4 * base.triangles.size());
}

TEST(PackedModel, DistancesAreRoundedUpToFloats) {
  PackedFixture made = packed_fixture(test::octahedron(), 1);
  for (const double distance : {0.0, 1e-9, 0.00123456, 0.1234, 0.99999, 3.3333e-5}) {
    made.detail.reach[1].rms = distance;
    const double read = read_packed(write_packed(made.detail, {made.base_stream})).levels[0].reach.rms;
    EXPECT_GE(read, distance);
    EXPECT_LE(read, distance * 1.0000002);
  }
}

TEST(PackedModel, AnyStepRoundTripsExactly) {
  PackedFixture made = packed_fixture(test::octahedron(), 1);
  for (const float step : {1e-38F, 1e-45F, 9.99e17F, 0.1F, 1.0F / 3, 16777217.0F, 5e-7F}) {
    made.detail.levels[0].step = step;
    EXPECT_EQ(read_packed(write_packed(made.detail, {made.base_stream})).levels[0].stream.step, step);
  }
}

TEST(PackedModel, AnyViewerReadsTheBase) {
  const PackedFixture made = packed_fixture(test::icosahedron(), 2);
  const FormattedMesh seen = gltf::flatten_scene(made.glb, {});
  EXPECT_EQ(seen.positions.size(), made.detail.base.triangles.positions.size());
  EXPECT_EQ(seen.triangles, made.detail.base.triangles.triangles);
  const Json json = test::json_of_glb(made.glb);
  EXPECT_EQ(json["extensionsUsed"], (Json{"KHR_draco_mesh_compression", "PAPILIO_detail"}));
  EXPECT_EQ(json["extensionsRequired"], (Json{"KHR_draco_mesh_compression"}));
}

TEST(PackedModel, StreamsFollowTheBaseLevelByLevel) {
  const PackedFixture made = packed_fixture(test::icosahedron(), 2, 31);
  std::string expected;
  for (const DetailStream& stream : made.detail.levels) expected.append(stream.bytes.begin(), stream.bytes.end());
  const std::string binary = test::binary_of_glb(made.glb);
  EXPECT_EQ(binary.substr(0, made.base_stream.size()), made.base_stream);
  EXPECT_EQ(binary.substr(made.base_stream.size() + 18 + 2 * 16, expected.size()), expected);
}

TEST(PackedModel, EmptyStreamIsRead) {
  const PackedFixture made = packed_fixture(test::icosahedron(), 2, 0);
  const PackedModel model = read_packed(made.glb);
  EXPECT_TRUE(model.levels.at(1).stream.bytes.empty());
  EXPECT_EQ(model.levels.at(1).stream.step, made.detail.levels[1].step);
}

TEST(PackedModel, NoLevelsAndTheMostLevelsAreRead) {
  EXPECT_EQ(read_packed(packed_fixture(test::tetrahedron(), 0).glb).levels.size(), 0U);
  EXPECT_EQ(read_packed(packed_fixture(test::tetrahedron(), most_detail_levels).glb).levels.size(), 10U);
}

TEST(PackedModel, LevelsBeyondTheRequestAreNotRead) {
  const PackedModel model = read_packed(packed_fixture(test::icosahedron(), 4).glb, {.levels = 2});
  EXPECT_EQ(model.levels.size(), 2U);
  EXPECT_EQ(model.declared_levels, 4U);
}

TEST(PackedModel, TruncatedFileIsRefusedByDefault) {
  const PackedFixture made = packed_fixture(test::icosahedron(), 3);
  for (size_t size = 0; size < made.glb.size(); ++size) EXPECT_NE(refusal(made.glb.substr(0, size)), "read") << size;
}

TEST(PackedModel, PrefixGivesItsCompleteLevels) {
  constexpr size_t bytes_per_level = 40;
  const PackedFixture made = packed_fixture(test::icosahedron(), 3, bytes_per_level);
  const size_t base_end = binary_begin(made.glb) + made.base_stream.size() + 18 + 3 * 16;
  for (size_t size = 0; size <= made.glb.size(); ++size) {
    const std::string prefix = made.glb.substr(0, size);
    if (size < base_end) {
      EXPECT_EQ(refusal(prefix, {.may_be_cut = true}), "mesh_not_gltf") << size;
      continue;
    }
    const PackedModel model = read_packed(prefix, {.may_be_cut = true});
    ASSERT_EQ(model.levels.size(), std::min<size_t>(3, (size - base_end) / bytes_per_level)) << size;
    EXPECT_EQ(model.base, made.detail.base);
    for (size_t l = 0; l < model.levels.size(); ++l)
      EXPECT_EQ(model.levels[l].stream.bytes, made.detail.levels[l].bytes);
  }
}

TEST(PackedModel, TrailingBytesAreRefusedEvenIfTruncationIsAllowed) {
  EXPECT_EQ(refusal(packed_fixture(test::icosahedron(), 1).glb + "more", {.may_be_cut = true}), "mesh_not_gltf");
}

TEST(PackedModel, OtherVersionsAreRefused) {
  const std::string glb = packed_fixture(test::icosahedron(), 1).glb;
  for (const int version : {0, 1, 2, 4, 1000}) {
    const std::string other = with(glb, [&](Json& json) { json["version"] = version; });
    EXPECT_EQ(refusal(other), "mesh_unsupported");
  }
  EXPECT_EQ(refusal(with(glb, [](Json& json) { json["version"] = "1"; })), "mesh_not_gltf");
  EXPECT_EQ(refusal(with(glb, [](Json& json) { json.erase("version"); })), "mesh_not_gltf");
}

TEST(PackedModel, NonPositiveAndHugeStepsAreRefused) {
  const PackedFixture made = packed_fixture(test::icosahedron(), 2);
  EXPECT_EQ(refusal(with_table(made, steps_at[1], bytes_of(0.5F))), "read");
  for (const float step : {0.0F, -1.0F, 1.1e18F, std::numeric_limits<float>::infinity(), std::nanf("")})
    for (const size_t at : steps_at) EXPECT_EQ(refusal(with_table(made, at, bytes_of(step))), "mesh_not_gltf") << step;
}

TEST(PackedModel, NegativeAndNonFiniteDistancesAreRefused) {
  const PackedFixture made = packed_fixture(test::icosahedron(), 1);
  for (const size_t at : distances_at) {
    EXPECT_EQ(refusal(with_table(made, at, bytes_of(0.5F))), "read");
    for (const float distance : {-1e-9F, std::numeric_limits<float>::infinity(), std::nanf("")})
      EXPECT_EQ(refusal(with_table(made, at, bytes_of(distance))), "mesh_not_gltf") << at << " " << distance;
  }
}

TEST(PackedModel, InvalidBufferViewIsRefused) {
  const std::string glb = packed_fixture(test::icosahedron(), 2).glb;
  for (const Json& view : {Json(0), Json(2), Json(1000), Json(-1), Json("1"), Json(nullptr)})  // 0: the base's
    EXPECT_EQ(refusal(with(glb, [&](Json& json) { json["bufferView"] = view; })), "mesh_not_gltf") << view;
  EXPECT_EQ(refusal(with(glb, [](Json& json) { json.erase("bufferView"); })), "mesh_not_gltf");
  for (const char* key : {"byteLength", "byteOffset"})
    for (const int value : {0, 10, 40, 100000})
      EXPECT_EQ(refusal(changed(glb, [&](Json& json) { json["bufferViews"][1][key] = value; })), "mesh_not_gltf");
  EXPECT_EQ(refusal(changed(glb, [](Json& json) { json["bufferViews"][1]["byteStride"] = 4; })), "mesh_not_gltf");
}

TEST(PackedModel, SizesThatContradictTheViewAreRefused) {
  const PackedFixture made = packed_fixture(test::icosahedron(), 2, 40);
  EXPECT_EQ(refusal(with_table(made, level_bytes_at, bytes_of(40U))), "read");
  for (const uint32_t bytes : {0U, 39U, 41U, 0xFFFFFFFFU})
    EXPECT_EQ(refusal(with_table(made, level_bytes_at, bytes_of(bytes))), "mesh_not_gltf") << bytes;
  for (const uint32_t bytes : {1U, 40U, 0xFFFFFFFFU})
    EXPECT_EQ(refusal(with_table(made, curve_bytes_at, bytes_of(bytes))), "mesh_not_gltf") << bytes;
}

TEST(PackedModel, TooManyLevelsAndUnknownFlagsAreRefused) {
  const PackedFixture made = packed_fixture(test::icosahedron(), most_detail_levels);
  for (const int levels : {0, 9, 11, 255})
    EXPECT_EQ(refusal(with_table(made, 0, std::string(1, static_cast<char>(levels)))), "mesh_not_gltf") << levels;
  for (const int flags : {1, 2, 4, 128})
    EXPECT_EQ(refusal(with_table(made, 1, std::string(1, static_cast<char>(flags)))), "mesh_not_gltf") << flags;
}

TEST(PackedModel, CountsThatContradictTheBaseAreRefused) {
  const PackedFixture made = packed_fixture(test::icosahedron(), 2);
  EXPECT_EQ(refusal(with_table(made, edges_at, bytes_of(30U))), "read");
  EXPECT_EQ(refusal(with_table(made, edges_at, bytes_of(31U))), "mesh_not_gltf");
  for (const size_t accessor : {0, 1})
    EXPECT_EQ(refusal(changed(made.glb, [&](Json& json) { json["accessors"][accessor]["count"] = 66; })),
              "mesh_not_gltf");
}

TEST(PackedModel, FacesBeyondTheLimitAreRefused) {
  const std::string glb = packed_fixture(test::icosahedron(), 4).glb;  // 20 faces, 5120 at level 4
  const Limits limits{.max_output_faces = 5119};
  EXPECT_EQ(refusal(glb, {.limits = limits}), "result_too_large");
  EXPECT_EQ(refusal(glb, {.limits = limits, .levels = 3}), "read");
  EXPECT_EQ(refusal(glb, {.limits = {.max_output_faces = 5120}}), "read");
  EXPECT_EQ(refusal(glb, {.limits = {.max_input_faces = 19}}), "mesh_too_large");
}

TEST(PackedModel, FaceLimitHoldsBeforeTheBaseIsDecoded) {
  const std::string glb = packed_fixture(test::icosahedron(), 4).glb;
  const std::string large = changed(glb, [](Json& json) { json["accessors"][1]["count"] = 6'000'000; });
  EXPECT_EQ(refusal(large), "result_too_large");
}

TEST(PackedModel, CountsOfAnOpenBaseEqualTheDecoded) {
  PackedFixture made = packed_fixture(test::grid(3, 2), 3);
  made.detail.base.curves = {1, 2, 3};
  const PackedModel model = read_packed(write_packed(made.detail, {made.base_stream}));
  EXPECT_EQ(model.base, made.detail.base);
  const TriangleMesh fine = test::decoded_triangles(model.base, model.streams());
  ASSERT_EQ(model.levels.size(), 3U);
  uint64_t vertices = model.base.triangles.positions.size();
  for (const PackedLevel& level : model.levels) vertices += level.vertices;
  EXPECT_EQ(vertices, fine.positions.size());
  EXPECT_EQ(model.levels.back().faces, fine.triangles.size());
}

TEST(PackedModel, NonManifoldBaseIsRefused) {
  const TriangleMesh pinched = test::join(test::fan(6, false), test::fan(6, false, -3), 0);
  const TriangleMesh three_faces{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 1}, {0, -1, -1}},
                                 .triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
  for (const TriangleMesh& base : {pinched, three_faces}) {
    PackedFixture made = packed_fixture(test::icosahedron(), 1);
    const Mesh mesh = build_mesh(base);
    made.base_stream = write_draco(mesh, tight_box(bounding_box(mesh.positions)), {.speed = 0});
    made.detail.base = {mesh.triangles()};
    EXPECT_NE(refusal(write_packed(made.detail, {made.base_stream})), "read");
  }
}

TEST(PackedModel, ExtensionsMayHaveAnyOrder) {
  const PackedFixture made = packed_fixture(test::icosahedron(), 2);
  const std::string other = changed(made.glb, [](Json& json) {
    Json& extensions = json["meshes"][0]["primitives"][0]["extensions"];
    const Json draco = extensions["KHR_draco_mesh_compression"];
    extensions.erase("KHR_draco_mesh_compression");
    extensions["VENDOR_unknown"] = {{"kept", true}};
    extensions["KHR_draco_mesh_compression"] = draco;
    std::swap(json["extensionsUsed"][0], json["extensionsUsed"][1]);
    extension_in(json)["extras"] = "kept";
  });
  EXPECT_EQ(read_packed(other).base, made.detail.base);
}

TEST(PackedModel, UnsupportedScenesAreRefused) {
  const std::string glb = packed_fixture(test::icosahedron(), 1).glb;
  const auto expect = [&](const std::function<void(Json&)>& change) {
    EXPECT_EQ(refusal(changed(glb, change)), "mesh_unsupported");
  };
  expect([](Json& json) { json["nodes"][0]["translation"] = {1, 0, 0}; });
  expect([](Json& json) { json["nodes"].push_back({{"mesh", 0}}); });
  expect([](Json& json) { json["meshes"].push_back(json["meshes"][0]); });
  expect([](Json& json) { json["meshes"][0]["primitives"][0]["mode"] = 5; });
  expect([](Json& json) { json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 0; });
  expect([](Json& json) { json["meshes"][0]["primitives"][0]["extensions"].erase("PAPILIO_detail"); });
}

TEST(PackedModel, OnlyFilesWithTheExtensionArePacked) {
  const PackedFixture made = packed_fixture(test::icosahedron(), 1);
  EXPECT_TRUE(is_packed(made.glb));
  EXPECT_FALSE(is_packed(write_plain(made.detail.base.triangles, {made.base_stream})));
  for (const char* bytes : {"", "glTF", "DRACO", "{\"asset\":{}}"}) EXPECT_FALSE(is_packed(bytes));
}

TEST(PackedModel, DescriptionHasCountsAndBytes) {
  const auto json = nlohmann::json::parse(describe(read_packed(packed_fixture(test::icosahedron(), 2).glb)));
  EXPECT_EQ(json["base"]["faces"], 20);
  EXPECT_EQ(json["levels"][1]["new_vertices"], 120);
  EXPECT_EQ(json["levels"][1]["faces"], 320);
  EXPECT_EQ(json["levels"][0]["bytes"], 40);
}

}  // namespace
}  // namespace papilio::proto::detail
