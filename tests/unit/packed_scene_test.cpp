#include <gtest/gtest.h>

#include "proto/detail/packed_reader.h"
#include "proto/gltf/packing.h"
#include "tests/support/gltf_refinement.h"
#include "tests/support/packed_model.h"
#include "tests/support/shapes.h"

// Packed models in the pipeline of scenes, which knows bases alone.

namespace papilio::proto::detail {
namespace {

constexpr size_t view_bytes = 5000;  // of a level

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

TEST(PackedScene, ACopiedSceneKeepsItsResiduals) {
  const std::string glb = packed_scene();
  EXPECT_EQ(read_packed(test::refined(glb, {{"levels", "0"}}).bytes).levels.size(), 2U);
  const gltf::UnpackedScene files = gltf::unpack_scene(glb, "a.bin");
  const std::string back =
      gltf::pack_scene(files.document, [&](const std::string&) { return files.buffers.at(0).second; }, {});
  const PackedModel model = read_packed(back);
  ASSERT_EQ(model.levels.size(), 2U);
  EXPECT_EQ(model.levels[1].stream.bytes, read_packed(glb).levels[1].stream.bytes);
}

}  // namespace
}  // namespace papilio::proto::detail
