#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "proto/problem.h"
#include "tests/support/gltf_refinement.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"

// Levels of scenes, cached scenes and instances.

namespace papilio::proto::gltf {
namespace {

using test::faces_of;
using test::GltfScene;
using test::refined;

/// A bunny of size 1 and a torus with two nodes: a large one, and a small one far away.
GltfScene scene_of_three_nodes() {
  TriangleMesh bunny = test::real_mesh("bunny600.obj");
  const Box box = bounding_box(bunny.positions);
  const auto scale = static_cast<float>(1 / box.diagonal());
  for (Vec3f& p : bunny.positions) p = scale * (p - to_float(box.centre()));
  GltfScene scene;
  scene.add_mesh(bunny);
  scene.add_mesh(test::torus(12, 8));
  scene.add_node({{"mesh", 1}, {"scale", {0.01, 0.01, 0.01}}, {"translation", {3, 0, 0}}});
  return scene;
}

const std::vector<QueryFields>& ways() {
  static const std::vector<QueryFields> all{{{"levels", "2"}},
                                            {{"levels", "3"}, {"tolerance", "0.002"}},
                                            {{"levels", "3"}, {"flatness", "0.9"}},
                                            {{"levels", "4"}, {"max_faces", "3000"}},
                                            {{"view.eye", "0,0,4"}, {"view.error_pixels", "1"}, {"levels", "3"}},
                                            {{"levels", "2"}, {"output.compress", "draco"}, {"output.normals", "true"}},
                                            {{"levels", "0"}}};
  return all;
}

std::vector<EncodedLevel> levels_of(SceneRefinement&& refinement) {
  std::vector<EncodedLevel> levels;
  const EncodedLevel last =
      refinement.run({.on_level = [&](const EncodedLevel& level) { levels.push_back(level); }, .cancelled = {}});
  EXPECT_FALSE(levels.empty());
  EXPECT_EQ(levels.back().bytes, last.bytes);
  return levels;
}

TEST(GltfLevels, EachLevelIsASceneAndTheLastIsTheResult) {
  const std::string glb = scene_of_three_nodes().glb();
  for (const QueryFields& fields : ways()) {
    const EncodedLevel whole = refined(glb, fields);
    const std::vector<EncodedLevel> levels = levels_of(SceneRefinement(glb, parse_query(fields), {}));
    EXPECT_EQ(levels.back().bytes, whole.bytes);
    EXPECT_EQ(levels.back().statistics.stop_reason, whole.statistics.stop_reason);
    EXPECT_EQ(levels.size(), static_cast<size_t>(whole.statistics.level) + 1);
    for (size_t k = 0; k < levels.size(); ++k) {
      const Statistics& statistics = levels[k].statistics;
      EXPECT_EQ(statistics.level, static_cast<int>(k));
      EXPECT_EQ(faces_of(levels[k].bytes, 0) + faces_of(levels[k].bytes, 1), statistics.faces);
      EXPECT_EQ(statistics.stop_reason.has_value(), k + 1 == levels.size());
      if (k > 0) {
        EXPECT_GT(statistics.faces, levels[k - 1].statistics.faces);
      }
    }
    EXPECT_EQ(levels[0].statistics.faces, 600U + 192U);
  }
}

TEST(GltfLevels, ThrowingCallerStopsTheLevels) {
  const std::string glb = scene_of_three_nodes().glb();
  SceneRefinement refinement(glb, parse_query({{"levels", "3"}}), {});
  EXPECT_THROW((void)refinement.run(
                   {.on_level = [](const EncodedLevel&) { throw Problem(Code::cancelled, "gone"); }, .cancelled = {}}),
               Problem);
}

#if defined(__SANITIZE_THREAD__)
constexpr int turns = 1;  // two take a minute
#else
constexpr int turns = 2;
#endif

TEST(GltfLevels, CachedSceneGivesIdenticalBytes) {
  const auto glb = std::make_shared<const std::string>(scene_of_three_nodes().glb());
  for (const uint64_t budget : {uint64_t{1} << 30, uint64_t{1} << 20}) {
    const auto shared = std::make_shared<const SharedScene>(glb, Limits{}, budget);
    const uint64_t before = shared->bytes();
    for (int turn = 0; turn < turns; ++turn)
      for (const QueryFields& fields : ways()) {
        const EncodedLevel cold = refined(*glb, fields);
        const EncodedLevel warm = SceneRefinement(shared, parse_query(fields), {}).run();
        EXPECT_EQ(cold.bytes, warm.bytes);
        EXPECT_EQ(cold.statistics.error, warm.statistics.error);
        EXPECT_EQ(levels_of(SceneRefinement(shared, parse_query(fields), {})).back().bytes, cold.bytes);
      }
    EXPECT_GT(shared->bytes(), before);
    EXPECT_LT(shared->bytes(), before + budget + (uint64_t{8} << 20));  // plus the level of their edges
  }
}

TEST(GltfInstances, InstancesShareAMeshUnlessSplit) {
  const std::string glb = scene_of_three_nodes().glb();
  const QueryFields fields{{"tolerance", "0.001"}};
  const EncodedLevel together = refined(glb, fields);
  QueryFields apart_fields = fields;
  apart_fields.emplace_back("split_instances", "true");
  const EncodedLevel apart = refined(glb, apart_fields);
  const auto json = test::json_of_glb(apart.bytes);
  ASSERT_EQ(json["meshes"].size(), 3U);
  EXPECT_EQ(json["nodes"][1]["mesh"], 1);
  EXPECT_EQ(json["nodes"][2]["mesh"], 2);
  EXPECT_EQ(faces_of(apart.bytes, 1), faces_of(together.bytes, 1));
  EXPECT_GT(faces_of(apart.bytes, 1), 192U);
  EXPECT_EQ(faces_of(apart.bytes, 2), 192U);  // too small to be split
  EXPECT_EQ(apart.statistics.faces, faces_of(apart.bytes, 0) + faces_of(apart.bytes, 1) + 192U);
}

/// A scene whose second node has EXT_mesh_gpu_instancing, at a hundredth of the first node's scale except for the last
/// instance.
GltfScene scene_of_gpu_instances(float last_scale) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  scene.add_mesh(test::icosahedron());
  scene.json["nodes"][0]["scale"] = {10, 10, 10};
  scene.json["nodes"][1]["scale"] = {0.1, 0.1, 0.1};
  const size_t moves = scene.add_accessor(std::vector<float>{0, 0, 0, 20, 0, 0}, "VEC3");
  const size_t scales = scene.add_accessor(std::vector<float>{1, 1, 1, last_scale, last_scale, last_scale}, "VEC3");
  scene.json["nodes"][1]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", moves},
                                                                                   {"SCALE", scales}};
  return scene;
}

TEST(GltfInstances, GpuInstancesCountAtTheirScales) {
  const QueryFields fields{{"tolerance", "0.001"}};
  const std::string same = refined(scene_of_gpu_instances(100).glb(), fields).bytes;
  EXPECT_GT(faces_of(same, 0), 1000U);
  EXPECT_EQ(faces_of(same, 1), faces_of(same, 0));
  EXPECT_EQ(faces_of(refined(scene_of_gpu_instances(1).glb(), fields).bytes, 1), 20U);
}

TEST(GltfInstances, GpuInstancesAreCounted) {
  GltfScene scene = scene_of_gpu_instances(1);
  for (size_t a = scene.json["accessors"].size() - 2; a < scene.json["accessors"].size(); ++a) {
    scene.json["accessors"][a].erase("bufferView");  // zeros: no bytes bound the count
    scene.json["accessors"][a]["count"] = 1'000'001;
  }
  try {
    (void)refined(scene.glb(), {});
    FAIL() << "was not refused";
  } catch (const Problem& problem) {
    EXPECT_EQ(problem.code(), Code::mesh_too_large) << problem.what();
  }
}

TEST(GltfInstances, SplittingAMeshThatIsNoSceneIsRefused) {
  const std::string draco = write_draco_exact(test::icosahedron());
  EXPECT_THROW(Refinement(draco, parse_query({{"split_instances", "true"}}), {}), Problem);
}

TEST(GltfInstances, CopiesBeyondTheLimitAreRefused) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  scene.json["meshes"][0]["extras"] = std::string(1 << 20, 'x');
  for (int n = 0; n < 16; ++n) scene.add_node({{"mesh", 0}});
  EXPECT_THROW((void)refined(scene.glb(), {{"levels", "1"}, {"split_instances", "true"}}), Problem);
  EXPECT_NO_THROW((void)refined(scene.glb(), {{"levels", "1"}}));
}

}  // namespace
}  // namespace papilio::proto::gltf
