#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "papilio/refine.h"
#include "proto/gltf/flattening.h"
#include "proto/gltf/vertices.h"
#include "proto/problem.h"
#include "tests/support/gltf_refinement.h"
#include "tests/support/shapes.h"

namespace papilio::proto::gltf {
namespace {

using test::faces_of;
using test::geometry_of;
using test::GltfScene;
using test::refined;
using Json = GltfScene::Json;

using Point = std::array<float, 3>;
Point point_of(Vec3f p) { return {p.x, p.y, p.z}; }

std::multiset<Point> corners_of(const MeshGeometry& geometry) {
  std::multiset<Point> corners;
  for (const TrianglePrimitive& primitive : geometry.primitives) {
    const Buffer<Vec3f> positions = vertex_positions(geometry.sets[primitive.set]);
    for (const Triangle& triangle : primitive.triangles)
      for (const uint32_t v : triangle) corners.insert(point_of(positions[v]));
  }
  return corners;
}

TEST(GltfScene, PositionsEqualTheCores) {
  const TriangleMesh shape = test::torus(8, 6);
  GltfScene scene;
  scene.add_mesh(shape);
  Options options;
  options.levels = 2;
  const TriangleMesh expected = refine(build_mesh(shape), options).mesh.triangles();
  std::multiset<Point> corners;
  for (const Triangle& triangle : expected.triangles)
    for (const uint32_t v : triangle) corners.insert(point_of(expected.positions[v]));
  const EncodedLevel made = refined(scene.glb(), {{"levels", "2"}});
  EXPECT_EQ(corners_of(geometry_of(made.bytes)), corners);
  EXPECT_EQ(made.statistics.faces, 16 * shape.triangles.size());
  EXPECT_EQ(made.statistics.vertices, expected.positions.size());
  EXPECT_EQ(made.statistics.level, 2);
}

TEST(GltfScene, SmoothingGroupsMarkCreasesAsInTheCore) {
  // A pyramid with smooth sides in group 1 over a base of group 0; each face has its own points.
  const Buffer<Vec3f> corners{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 0.5F}};
  TriangleMesh shape;
  std::vector<float> groups;
  for (const Triangle& face : Buffer<Triangle>{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {2, 1, 0}, {3, 2, 0}}) {
    const auto first = static_cast<uint32_t>(shape.positions.size());
    for (const uint32_t corner : face) shape.positions.push_back(corners[corner]);
    shape.triangles.push_back({first, first + 1, first + 2});
    groups.resize(shape.positions.size(), shape.triangles.size() > 4 ? 0.0F : 1.0F);
  }
  GltfScene scene;
  scene.add_mesh(shape);
  const std::string plain = scene.glb();
  scene.primitive()["attributes"]["_SMOOTHING_GROUP"] = scene.add_accessor(groups, "SCALAR");
  const std::string marked = scene.glb();
  shape.attributes = {{.values = {groups.begin(), groups.end()}, .is_smoothing_group = true}};
  Options options;
  options.levels = 2;
  options.shape = Shape::organic;
  const Result expected = refine(build_mesh(shape), options);
  const TriangleMesh mesh = expected.mesh.triangles();
  std::multiset<Point> found;
  for (const Triangle& triangle : mesh.triangles)
    for (const uint32_t v : triangle) found.insert(point_of(mesh.positions[v]));
  const EncodedLevel made = refined(marked, {{"levels", "2"}, {"shape", "organic"}});
  EXPECT_EQ(corners_of(geometry_of(made.bytes)), found);
  EXPECT_NE(corners_of(geometry_of(refined(plain, {{"levels", "2"}, {"shape", "organic"}}).bytes)), found);
  // The refined scene has the groups of its faces, and a mesh of it, too.
  const MeshGeometry geometry = geometry_of(made.bytes);
  const VertexStream* stream = geometry.sets[0].find("_SMOOTHING_GROUP");
  ASSERT_NE(stream, nullptr);
  for (uint32_t v = 0; v < geometry.sets[0].count; ++v)
    EXPECT_TRUE(stream->elements.number(v, 0) == 0 || stream->elements.number(v, 0) == 1);
  const FormattedMesh flat = flatten_scene(made.bytes, Limits{});
  ASSERT_EQ(flat.attributes.size(), 1U);
  EXPECT_TRUE(flat.attributes[0].is_smoothing_group);
  const MeshGeometry again = geometry_of(scene_of_mesh(flat, {}));
  EXPECT_NE(again.sets[0].find("_SMOOTHING_GROUP"), nullptr);
}

TEST(GltfScene, StripsFansAndLooseTrianglesBecomeOneSurface) {
  GltfScene scene;
  scene.add_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}}});
  scene.primitive()["mode"] = 5;
  scene.primitive().erase("indices");
  const EncodedLevel made = refined(scene.glb(), {{"levels", "1"}});
  EXPECT_EQ(made.statistics.faces, 8U);
  EXPECT_EQ(made.statistics.vertices, 9U);
  const Json primitive = test::json_of_glb(made.bytes)["meshes"][0]["primitives"][0];
  EXPECT_FALSE(primitive.contains("mode"));
  EXPECT_TRUE(primitive.contains("indices"));
}

TEST(GltfScene, NormalsFollowTheSurfaceAndTheInputsSplits) {
  const TriangleMesh shape = test::icosahedron();
  GltfScene scene;
  scene.add_mesh(shape);
  scene.primitive()["attributes"]["NORMAL"] = scene.add_accessor(
      [&] {
        std::vector<float> numbers;
        for (const Vec3f& p : shape.positions) numbers.insert(numbers.end(), {p.x, p.y, p.z});
        return numbers;
      }(),
      "VEC3");
  const MeshGeometry smooth = geometry_of(refined(scene.glb(), {{"levels", "2"}}).bytes);
  EXPECT_EQ(smooth.sets[0].count, 162U);
  const Buffer<Vec3f> positions = vertex_positions(smooth.sets[0]);
  const Elements& normals = smooth.sets[0].find("NORMAL")->elements;
  for (uint32_t i = 0; i < smooth.sets[0].count; ++i) {
    const Vec3d normal{normals.number(i, 0), normals.number(i, 1), normals.number(i, 2)};
    EXPECT_NEAR(length(normal), 1, 1e-6);
    EXPECT_GT(dot(normal, to_double(positions[i])) / length(to_double(positions[i])), 0.98);
  }

  const TriangleMesh cube = test::cube();  // with face normals
  GltfScene flat;
  Buffer<Vec3f> corners;
  std::vector<float> directions;
  for (const Triangle& t : cube.triangles) {
    const Vec3f n = cross(cube.positions[t[1]] - cube.positions[t[0]], cube.positions[t[2]] - cube.positions[t[0]]);
    const float size = length(n);
    for (const uint32_t v : t) {
      corners.push_back(cube.positions[v]);
      directions.insert(directions.end(), {n.x / size, n.y / size, n.z / size});
    }
  }
  flat.add_mesh({corners, {{0, 1, 2}}});
  flat.primitive().erase("indices");
  flat.primitive()["attributes"]["NORMAL"] = flat.add_accessor(directions, "VEC3");
  const MeshGeometry hard = geometry_of(refined(flat.glb(), {{"levels", "2"}, {"shape", "mechanical"}}).bytes);
  EXPECT_EQ(hard.sets[0].count, 6U * 25);  // a separate grid on each side
  const Elements& of_sides = hard.sets[0].find("NORMAL")->elements;
  for (uint32_t i = 0; i < hard.sets[0].count; ++i) {
    double largest = 0;
    for (uint32_t c = 0; c < 3; ++c) largest = std::max(largest, std::abs(of_sides.number(i, c)));
    EXPECT_NEAR(largest, 1, 1e-6);
  }
}

TEST(GltfScene, WeightsOfJointsAreAddedJointByJoint) {
  GltfScene scene;
  scene.add_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  Json& attributes = scene.primitive()["attributes"];
  attributes["JOINTS_0"] = scene.add_accessor(std::vector<uint8_t>{0, 1, 0, 0, 2, 3, 1, 4, 5, 0, 0, 0}, "VEC4");
  attributes["WEIGHTS_0"] =
      scene.add_accessor(std::vector<uint8_t>{128, 127, 0, 0, 100, 80, 40, 35, 255, 0, 0, 0}, "VEC4", true);
  const MeshGeometry made = geometry_of(refined(scene.glb(), {{"levels", "1"}}).bytes);
  const VertexSet& set = made.sets[0];
  ASSERT_EQ(set.count, 6U);
  const Elements& joints = set.find("JOINTS_0")->elements;
  const Elements& weights = set.find("WEIGHTS_0")->elements;
  const Buffer<Vec3f> positions = vertex_positions(set);
  bool seen = false;
  for (uint32_t i = 0; i < 6; ++i) {
    double sum = 0;
    for (uint32_t k = 0; k < 4; ++k) sum += weights.number(i, k);
    EXPECT_EQ(sum, 255);
    if (positions[i] == Vec3f{0.5F, 0, 0}) {  // between the first two: joints 1 (167), 0 (128), 2 (100), 3 (80), 4 (35)
      seen = true;
      const std::array<double, 4> named{1, 0, 2, 3};
      for (uint32_t k = 0; k < 4; ++k) EXPECT_EQ(joints.number(i, k), named[k]);
      EXPECT_NEAR(weights.number(i, 0), 255.0 * 167 / 475, 1.5);
      EXPECT_NEAR(weights.number(i, 3), 255.0 * 80 / 475, 0.51);
    }
  }
  EXPECT_TRUE(seen);
}

TEST(GltfScene, AttributesAreInterpolatedOrCopiedByKind) {
  GltfScene scene;
  scene.add_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  Json& attributes = scene.primitive()["attributes"];
  attributes["TEXCOORD_0"] = scene.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2");
  attributes["COLOR_0"] =
      scene.add_accessor(std::vector<uint8_t>{0, 0, 0, 255, 100, 0, 0, 255, 0, 50, 0, 255}, "VEC4", true);
  attributes["_FEATURE_ID_0"] = scene.add_accessor(std::vector<float>{7, 9, 11}, "SCALAR");
  attributes["_BATCH"] = scene.add_accessor(std::vector<uint16_t>{3, 0, 5, 0, 8, 0}, "VEC2");
  attributes["_HEAT"] = scene.add_accessor(std::vector<float>{1, 2, 4}, "SCALAR");
  attributes["TANGENT"] = scene.add_accessor(std::vector<float>{1, 0, 0, -1, 0, 1, 0, -1, 1, 0, 0, -1}, "VEC4");
  const MeshGeometry made = geometry_of(refined(scene.glb(), {{"levels", "1"}}).bytes);
  const VertexSet& set = made.sets[0];
  const Buffer<Vec3f> positions = vertex_positions(set);
  for (uint32_t i = 0; i < set.count; ++i) {
    const auto value = [&](const char* name, uint32_t c) { return set.find(name)->elements.number(i, c); };
    EXPECT_NEAR(value("TEXCOORD_0", 0), positions[i].x, 1e-6);
    EXPECT_NEAR(value("TEXCOORD_0", 1), positions[i].y, 1e-6);
    EXPECT_EQ(value("COLOR_0", 0), std::floor(100 * positions[i].x + 0.5));
    EXPECT_EQ(value("COLOR_0", 3), 255);
    EXPECT_NEAR(value("_HEAT", 0), 1 + positions[i].x + 3 * positions[i].y, 1e-6);
    EXPECT_TRUE((std::set<double>{7, 9, 11}).contains(value("_FEATURE_ID_0", 0)));
    EXPECT_TRUE((std::set<double>{3, 5, 8}).contains(value("_BATCH", 0)));
    EXPECT_NEAR(std::hypot(value("TANGENT", 0), value("TANGENT", 1), value("TANGENT", 2)), 1, 1e-6);
    EXPECT_EQ(value("TANGENT", 3), -1);
  }
}

TEST(GltfScene, FeatureIdsRoundTripThroughDraco) {
  const TriangleMesh shape = test::icosahedron();
  GltfScene scene;
  scene.add_mesh(shape);
  std::vector<float> numbers;
  for (size_t i = 0; i < shape.positions.size(); ++i) numbers.push_back(100'003.F * static_cast<float>(i));
  scene.primitive()["attributes"]["_FEATURE_ID_0"] = scene.add_accessor(numbers, "SCALAR");
  for (const char* levels : {"0", "2"}) {
    const MeshGeometry made =
        geometry_of(refined(scene.glb(), {{"levels", levels}, {"output.compress", "draco"}}).bytes);
    const Elements& ids = made.sets[0].find("_FEATURE_ID_0")->elements;
    std::set<double> found;
    for (uint64_t i = 0; i < ids.count; ++i) found.insert(ids.number(i, 0));
    EXPECT_EQ(found, std::set<double>(numbers.begin(), numbers.end())) << levels;
  }
}

/// A scene with two nodes of two equal meshes, at different scales.
GltfScene scene_of_two_scales(double first, double second) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  scene.add_mesh(test::icosahedron());
  scene.json["nodes"][0]["scale"] = {first, first, first};
  scene.json["nodes"][1]["scale"] = {second, second, second};
  scene.json["nodes"][1]["translation"] = {20, 0, 0};
  return scene;
}

TEST(GltfScene, ToleranceIsAShareOfTheScene) {
  const EncodedLevel made = refined(scene_of_two_scales(10, 0.1).glb(), {{"tolerance", "0.001"}});
  EXPECT_GT(faces_of(made.bytes, 0), 1000U);
  EXPECT_EQ(faces_of(made.bytes, 1), 20U);  // a hundredth of the size
  EXPECT_LE(made.statistics.error, 0.001);
  EXPECT_EQ(made.statistics.stop_reason, StopReason::converged);
}

TEST(GltfScene, ErrorIncludesTheGridOfDracoPositions) {
  const std::string scene = scene_of_two_scales(10, 0.1).glb();
  const QueryFields fields{{"tolerance", "0.0005"}, {"output.compress", "draco"}};
  const Statistics made = refined(scene, fields).statistics;
  EXPECT_LE(made.error, 0.0005);
  EXPECT_EQ(made.unreached, "");
  QueryFields coarse = fields;
  coarse.emplace_back("output.position_bits", "8");
  const Statistics rough = refined(scene, coarse).statistics;
  EXPECT_GT(rough.error, 0.0005);
  EXPECT_NE(rough.unreached.find("output.position_bits=8"), std::string::npos) << rough.unreached;
  coarse[1].second = "none";
  EXPECT_LE(refined(scene, coarse).statistics.error, 0.0005) << "without Draco there is no grid";
}

TEST(GltfScene, MeshIsFineEnoughForAllItsNodes) {
  GltfScene scene = scene_of_two_scales(10, 0.1);
  scene.json["nodes"].push_back({{"mesh", 1}, {"scale", {10, 10, 10}}});
  const EncodedLevel made = refined(scene.glb(), {{"tolerance", "0.001"}});
  EXPECT_EQ(faces_of(made.bytes, 0), faces_of(made.bytes, 1));
}

TEST(GltfScene, MaxFacesBoundsAllMeshesTogether) {
  for (const char* budget : {"40", "100", "777", "5000"}) {
    const EncodedLevel made = refined(scene_of_two_scales(10, 3).glb(), {{"levels", "5"}, {"max_faces", budget}});
    EXPECT_LE(made.statistics.faces, std::stoul(budget));
    EXPECT_GE(made.statistics.faces, std::stoul(budget) * 9 / 10);
    EXPECT_GE(faces_of(made.bytes, 0), faces_of(made.bytes, 1));
  }
  EXPECT_THROW(refined(scene_of_two_scales(1, 1).glb(), {{"max_faces", "39"}}), Problem);
}

TEST(GltfScene, ViewUsesTheNodesTransforms) {
  GltfScene scene = scene_of_two_scales(1, 1);
  const QueryFields view{{"view.eye", "0,0,30"}, {"view.target", "0,0,0"},     {"view.fov_y", "10"},
                         {"levels", "3"},        {"view.viewport", "500,500"}, {"view.edge_pixels", "1"}};
  const std::string glb = scene.glb();
  const EncodedLevel made = refined(glb, view);
  EXPECT_GT(faces_of(made.bytes, 0), 100U);
  EXPECT_EQ(faces_of(made.bytes, 1), 20U);             // beside the picture
  scene.json["nodes"][0]["translation"] = {0, 0, 60};  // behind the viewer
  EXPECT_EQ(faces_of(refined(scene.glb(), view).bytes, 0), 20U);
}

TEST(GltfScene, ViewOfATransformedNodeEqualsTheInverseView) {
  TriangleMesh shape = test::torus(12, 8);
  GltfScene scene;
  scene.add_mesh(shape);
  scene.json["nodes"][0]["scale"] = {4, 4, 4};
  scene.json["nodes"][0]["translation"] = {8, 0, 0};
  scene.json["nodes"][0]["rotation"] = {0, 0, 1, 0};  // half a turn
  const EncodedLevel made =
      refined(scene.glb(), {{"view.eye", "8,0,16"}, {"view.target", "8,0,0"}, {"view.error_pixels", "1"}});
  GltfScene moved;
  moved.add_mesh(shape);
  const EncodedLevel same =
      refined(moved.glb(),
              {{"view.eye", "0,0,4"}, {"view.target", "0,0,0"}, {"view.up", "0,-1,0"}, {"view.error_pixels", "1"}});
  EXPECT_GT(same.statistics.faces, 192U);
  EXPECT_EQ(made.statistics.faces, same.statistics.faces);
}

TEST(GltfScene, BacksOfOpenMeshesCountIfDoubleSided) {
  TriangleMesh sheet = test::grid(6, 6);
  for (Vec3f& p : sheet.positions) p.z = 0.3F * std::sin(p.x) * std::cos(p.y);
  const auto faces_from_behind = [](const TriangleMesh& mesh, bool is_double_sided) {
    GltfScene scene;
    scene.add_mesh(mesh);
    scene.json["materials"] = Json::array({{{"doubleSided", is_double_sided}}});
    scene.json["meshes"][0]["primitives"][0]["material"] = 0;
    const proto::QueryFields view{
        {"levels", "3"}, {"view.eye", "3,3,-9"}, {"view.target", "3,3,0"}, {"view.error_pixels", "1"}};
    return faces_of(refined(scene.glb(), view).bytes);
  };
  EXPECT_GT(faces_from_behind(sheet, true), 2 * faces_from_behind(sheet, false));
  const TriangleMesh closed = test::torus(12, 8);
  EXPECT_EQ(faces_from_behind(closed, true), faces_from_behind(closed, false));
}

TEST(GltfScene, LimitsCountAllMeshesOfAScene) {
  const std::string glb = scene_of_two_scales(1, 1).glb();
  EXPECT_NO_THROW(refined(glb, {{"levels", "2"}}, {.max_output_faces = 640}));
  EXPECT_THROW(refined(glb, {{"levels", "2"}}, {.max_output_faces = 639}), Problem);
  EXPECT_THROW(refined(glb, {{"levels", "2"}}, {.max_input_faces = 39}), Problem);
}

TEST(GltfScene, UnrefinedPrimitivesKeepTheirBytes) {
  const std::string glb = scene_of_two_scales(1, 1).glb();
  EXPECT_EQ(refined(glb, {{"levels", "0"}}).bytes, glb);
}

TEST(GltfScene, SceneWithoutTrianglesIsRefused) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  scene.primitive()["mode"] = 0;
  EXPECT_THROW(refined(scene.glb(), {}), Problem);
  scene.primitive()["mode"] = 4;
  EXPECT_THROW(refined(scene.glb(), {{"simplify_hidden", "true"}, {"view.eye", "0,0,3"}}), Problem);
  scene.json["nodes"][0]["children"] = {0};
  EXPECT_THROW(refined(scene.glb(), {}), Problem);
}

TEST(GltfScene, UnusedViewWithoutABufferIsRefused) {
  for (const Json& buffer : {Json("zero"), Json::array({0})})
    for (const bool is_compressed : {false, true}) {
      GltfScene scene;
      scene.add_mesh(test::icosahedron());
      Json view{{"buffer", buffer}, {"byteLength", 4}};
      if (is_compressed) view["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0}, {"byteLength", 4}};
      scene.json["bufferViews"].push_back(view);
      try {
        refined(scene.glb(), {{"levels", "1"}});
        ADD_FAILURE() << view << " was not refused";
      } catch (const Problem& problem) {
        EXPECT_EQ(problem.code(), Code::mesh_not_gltf) << problem.what();
      }
    }
}

TEST(GltfScene, NormalsAreAddedOnRequest) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  const MeshGeometry made = geometry_of(refined(scene.glb(), {{"levels", "1"}, {"output.normals", "true"}}).bytes);
  const VertexStream* normals = made.sets[0].find("NORMAL");
  ASSERT_NE(normals, nullptr);
  EXPECT_NEAR(
      std::hypot(normals->elements.number(0, 0), normals->elements.number(0, 1), normals->elements.number(0, 2)), 1,
      1e-6);
}

}  // namespace
}  // namespace papilio::proto::gltf
