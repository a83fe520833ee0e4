#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "proto/detail/find_packed.h"
#include "proto/detail/packed_reader.h"
#include "proto/draco_reader.h"
#include "proto/gltf/flattening.h"
#include "proto/gltf/packing.h"
#include "proto/problem.h"
#include "proto/quantization_box.h"
#include "tests/support/decoded_detail.h"
#include "tests/support/gltf_refinement.h"
#include "tests/support/packed_model.h"
#include "tests/support/shapes.h"
#include "tests/support/two_sided_distance.h"

// Packed models in refinements of scenes and meshes.

namespace papilio::proto::detail {
namespace {

constexpr size_t view_bytes = 5000;  // of a level

using Corners = std::array<std::array<float, 3>, 3>;

/// Returns the faces by the positions of their corners, sorted.
std::vector<Corners> sorted_faces(const TriangleMesh& mesh) {
  std::vector<Corners> faces;
  for (const Triangle& t : mesh.triangles) {
    Corners& face = faces.emplace_back();
    for (size_t i = 0; i < 3; ++i) face[i] = {mesh.positions[t[i]].x, mesh.positions[t[i]].y, mesh.positions[t[i]].z};
    std::ranges::rotate(face, std::ranges::min_element(face));
  }
  std::ranges::sort(faces);
  return faces;
}

TriangleMesh triangles_of(const std::string& glb) { return gltf::flatten_scene(glb, {}); }

TriangleMesh decoded_to(const PackedModel& model, int levels) {
  const std::vector<DetailStream> streams = model.streams();
  return test::decoded_triangles(model.base, std::span(streams).first(static_cast<size_t>(levels)));
}

std::string packed_scene() { return test::packed_fixture(test::icosahedron(), 2, view_bytes).glb; }

TEST(PackedScene, ResidualsOfARefinedBaseAreRemoved) {
  const std::string fine = test::refined(packed_scene(), {{"levels", "1"}}).bytes;
  const auto json = test::json_of_glb(fine);
  EXPECT_FALSE(is_packed(fine));
  EXPECT_EQ(json["extensionsUsed"], (test::GltfScene::Json{"KHR_draco_mesh_compression"}));
  EXPECT_EQ(json["extensionsRequired"], (test::GltfScene::Json{"KHR_draco_mesh_compression"}));
  EXPECT_LT(fine.size(), view_bytes);
  EXPECT_EQ(json["accessors"][1]["count"], 3 * 80);
}

TEST(PackedScene, ResidualsOfAnotherCompressionAreRemoved) {
  for (const char* compression : {"none", "draco", "meshopt"}) {
    const std::string made = test::refined(packed_scene(), {{"levels", "0"}, {"output.compress", compression}}).bytes;
    EXPECT_FALSE(is_packed(made));
    EXPECT_LT(made.size(), view_bytes);
  }
}

TEST(PackedScene, CopiedSceneKeepsItsResiduals) {
  const std::string glb = packed_scene();
  const gltf::UnpackedScene files = gltf::unpack_scene(glb, "a.bin");
  const std::string back =
      gltf::pack_scene(files.document, [&](const std::string&) { return files.buffers.at(0).second; }, {});
  const PackedModel model = read_packed(back);
  ASSERT_EQ(model.levels.size(), 2U);
  EXPECT_EQ(model.levels[1].stream.bytes, read_packed(glb).levels[1].stream.bytes);
}

TEST(PackedScene, LevelZeroIsTheBaseWithoutResiduals) {
  const std::string glb = packed_scene();
  const std::string base = test::refined(glb, {{"levels", "0"}}).bytes;
  const auto json = test::json_of_glb(base);
  EXPECT_FALSE(is_packed(base));
  EXPECT_EQ(json["extensionsUsed"], (test::GltfScene::Json{"KHR_draco_mesh_compression"}));
  EXPECT_LT(base.size(), view_bytes);
  EXPECT_EQ(sorted_faces(triangles_of(base)), sorted_faces(read_packed(glb).base.triangles));
  for (const auto& view : json["bufferViews"])
    EXPECT_LE(view.value("byteOffset", 0U) + view["byteLength"].get<size_t>(), json["buffers"][0]["byteLength"]);
}

TEST(PackedScene, LevelsEqualTheDecoders) {
  const std::string glb = packed_scene();
  const PackedModel model = read_packed(glb);
  const auto stored =
      std::make_shared<const gltf::SharedScene>(std::make_shared<const std::string>(glb), Limits{}, 1U << 20U);
  for (int levels = 0; levels <= 2; ++levels) {
    const auto expected = sorted_faces(decoded_to(model, levels));
    const QueryFields fields{{"levels", std::to_string(levels)}, {"output.compress", "none"}};
    EXPECT_EQ(sorted_faces(triangles_of(test::refined(glb, fields).bytes)), expected) << levels;
    const std::string from_store = gltf::SceneRefinement(stored, parse_query(fields), {}).run().bytes;
    EXPECT_EQ(sorted_faces(triangles_of(from_store)), expected) << levels;
  }
}

TEST(PackedScene, FurtherLevelsSubdivideTheFinest) {
  const std::string made = test::refined(packed_scene(), {{"levels", "4"}, {"output.compress", "none"}}).bytes;
  EXPECT_EQ(test::faces_of(made), 20U << 8U);
}

TEST(PackedScene, StreamedLevelsHaveTheSameVertices) {
  const std::string glb = packed_scene();
  std::vector<std::string> levels;
  RefinementHooks hooks;
  hooks.on_level = [&](const EncodedLevel& level) { levels.push_back(level.bytes); };
  (void)gltf::SceneRefinement(glb, parse_query({{"levels", "2"}, {"output.compress", "none"}}), {}).run(hooks);
  ASSERT_EQ(levels.size(), 3U);
  std::set<std::array<float, 3>> finest;
  for (const Vec3f p : triangles_of(levels[2]).positions) finest.insert({p.x, p.y, p.z});
  for (const std::string& level : levels) {
    EXPECT_FALSE(is_packed(level));
    for (const Vec3f p : triangles_of(level).positions) EXPECT_TRUE(finest.contains({p.x, p.y, p.z}));
  }
}

TEST(PackedScene, TinyToleranceEndsAtTheFinestLevel) {
  const EncodedLevel made = test::refined(packed_scene(), {{"tolerance", "0.000001"}, {"output.compress", "none"}});
  EXPECT_EQ(made.statistics.level, 2);
  EXPECT_EQ(made.statistics.error, 0);
  EXPECT_EQ(made.statistics.unreached, "");
  const PackedModel model = read_packed(packed_scene());
  EXPECT_EQ(sorted_faces(triangles_of(made.bytes)), sorted_faces(test::decoded_triangles(model.base, model.streams())));
}

TEST(PackedScene, MeshRequestsEqualTheDecodersLevels) {
  const std::string glb = packed_scene();
  const PackedModel model = read_packed(glb);
  for (int levels = 0; levels <= 2; ++levels) {
    const TriangleMesh expected = decoded_to(model, levels);
    const Parameters parameters = parse_query({{"levels", std::to_string(levels)}, {"output.position_bits", "16"}});
    const EncodedLevel made = Refinement(glb, parameters, {}).run();
    const TriangleMesh decoded = read_draco(made.bytes, {});
    EXPECT_EQ(decoded.triangles.size(), expected.triangles.size());
    const double most = grid_distance(bounding_box(model.base.triangles.positions), 16);
    EXPECT_LE(test::two_sided_distance(build_mesh(decoded), build_mesh(expected)).largest(), 1.01 * most);
    const auto stored = std::make_shared<const SharedMesh>(glb, Limits{}, 1U << 20U);
    EXPECT_EQ(Refinement(stored, parameters, {}).run().bytes, made.bytes);
  }
}

TEST(PackedScene, SceneOfALaterVersionIsReadAsItsBase) {
  std::string glb = packed_scene();
  const size_t at = glb.find("\"version\":3,");
  ASSERT_NE(at, std::string::npos);
  glb.replace(at, 12, "\"version\":7,");
  EXPECT_EQ(find_packed(glb, {}), std::nullopt);
  EXPECT_EQ(test::faces_of(test::refined(glb, {{"levels", "1"}}).bytes), 80U);
}

TEST(PackedScene, DamagedPackedSceneIsRefused) {
  std::string glb = packed_scene();
  constexpr std::string_view before = "\"version\":3,\"bufferView\":";
  const size_t at = glb.find(before);
  ASSERT_NE(at, std::string::npos);
  glb[at + before.size()] = '7';
  EXPECT_THROW((void)test::refined(glb, {{"levels", "1"}}), Problem);
}

TEST(PackedScene, LimitsCountOnlyRequestedLevels) {
  const Limits limits{.max_output_faces = 100};
  EXPECT_EQ(test::faces_of(test::refined(packed_scene(), {{"levels", "1"}}, limits).bytes), 80U);
  EXPECT_THROW((void)test::refined(packed_scene(), {{"levels", "2"}}, limits), Problem);
}

TEST(PackedScene, BytesIncludeDecodedLevels) {
  const test::PackedFixture packed = test::packed_fixture(test::torus(12, 8), 4);
  const gltf::SharedScene stored(std::make_shared<const std::string>(packed.glb), {}, 0);
  const uint64_t before = stored.bytes();
  const auto& detail = stored.decoded().scene.meshes[0].surface.mesh.detail;
  const size_t vertices = detail->new_vertices(3).size();
  EXPECT_EQ(vertices, 3 * 96 << 6);
  EXPECT_GE(stored.bytes(), before + sizeof(Vec3f) * vertices);
}

}  // namespace
}  // namespace papilio::proto::detail
