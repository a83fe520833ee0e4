#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "proto/gltf/vertices.h"
#include "tests/support/gltf_refinement.h"
#include "tests/support/shapes.h"

// Borders between primitives of any component types have no gaps.

namespace papilio::proto::gltf {
namespace {

using test::faces_of;
using test::geometry_of;
using test::GltfScene;
using test::refined;
using Json = GltfScene::Json;

using Position = std::array<float, 3>;
Position position_of(Vec3f p) { return {p.x, p.y, p.z}; }

std::string name_of(Compression compression) {
  return std::string(compression_names.at(static_cast<size_t>(compression)));
}

/// Returns the number of edges, by position, that do not have exactly two triangles.
size_t open_edges(const MeshGeometry& geometry) {
  std::map<std::pair<Position, Position>, int> uses;
  for (const TrianglePrimitive& primitive : geometry.primitives) {
    const Buffer<Vec3f> positions = vertex_positions(geometry.sets[primitive.set]);
    for (const Triangle& triangle : primitive.triangles)
      for (size_t i = 0; i < 3; ++i) {
        const Position a = position_of(positions[triangle[i]]);
        const Position b = position_of(positions[triangle[(i + 1) % 3]]);
        ++uses[{std::min(a, b), std::max(a, b)}];
      }
  }
  return static_cast<size_t>(std::ranges::count_if(uses, [](const auto& use) { return use.second != 2; }));
}

/// A closed shape in two primitives with separate vertices, each of half of the triangles.
GltfScene scene_of_two_materials(const TriangleMesh& shape) {
  GltfScene scene;
  scene.add_mesh(shape);
  scene.json["meshes"][0]["primitives"].clear();
  const size_t half = shape.triangles.size() / 2;
  for (int part = 0; part < 2; ++part) {
    const auto* begin = shape.triangles.begin() + (part == 0 ? 0 : half);
    const auto* end = part == 0 ? shape.triangles.begin() + half : shape.triangles.end();
    const Json positions = scene.add_positions(shape.positions);
    const Json indices = scene.add_indices(Buffer<Triangle>(begin, end));
    scene.json["meshes"][0]["primitives"].push_back(
        {{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"material", part}});
  }
  scene.json["materials"] = Json::array({Json::object(), Json::object()});
  return scene;
}

TEST(GltfBorders, BordersBetweenMaterialsStayClosed) {
  const std::string before = scene_of_two_materials(test::icosahedron()).glb();
  for (const char* tolerance : {"0", "0.01"})
    for (const Compression compression : {Compression::same, Compression::draco, Compression::meshopt}) {
      const EncodedLevel made =
          refined(before, {{"levels", "3"}, {"tolerance", tolerance}, {"output.compress", name_of(compression)}});
      const MeshGeometry geometry = geometry_of(made.bytes);
      EXPECT_GT(faces_of(made.bytes), 100U);
      EXPECT_EQ(open_edges(geometry), 0U) << tolerance << ' ' << name_of(compression);
      EXPECT_EQ(geometry.primitives.size(), 2U);
    }
}

/// Appends vectors, times `scale`, as int16. Returns the accessor's number.
size_t add_quantized(GltfScene& scene, const Buffer<Vec3f>& vectors, double scale) {
  std::vector<int16_t> numbers;
  for (const Vec3f& p : vectors)
    for (const float x : {p.x, p.y, p.z, 0.F}) numbers.push_back(static_cast<int16_t>(x * scale));
  const size_t accessor = scene.add_accessor(numbers, "VEC4");
  scene.json["accessors"][accessor]["type"] = "VEC3";
  scene.json["bufferViews"].back()["byteStride"] = 8;
  scene.json["extensionsUsed"] = scene.json["extensionsRequired"] = Json::array({"KHR_mesh_quantization"});
  return accessor;
}

TEST(GltfBorders, QuantizedPositionsKeepTheirGridOrBecomeFloats) {
  const TriangleMesh shape = test::icosahedron();
  const auto scene_with = [&](double scale) {
    GltfScene scene;
    scene.add_mesh(shape);
    scene.primitive()["attributes"]["POSITION"] = add_quantized(scene, shape.positions, scale);
    return scene.glb();
  };
  const MeshGeometry kept = geometry_of(refined(scene_with(1000), {{"levels", "2"}}).bytes);
  EXPECT_EQ(kept.sets[0].find("POSITION")->elements.format.type, ComponentType::int16);
  EXPECT_EQ(open_edges(kept), 0U);
  double largest = 0;
  for (const Vec3f& p : shape.positions) largest = std::max<double>({largest, p.x, p.y, p.z});
  const MeshGeometry widened = geometry_of(refined(scene_with(32767 / largest), {{"levels", "2"}}).bytes);
  EXPECT_EQ(widened.sets[0].find("POSITION")->elements.format.type, ComponentType::float32);
  EXPECT_EQ(open_edges(widened), 0U);
}

/// An icosahedron of which only the upper half bulges beyond y = 1; triangles from top to bottom.
TriangleMesh raised_icosahedron() {
  TriangleMesh shape = test::icosahedron();
  const auto height = [&](const Triangle& t) {
    return shape.positions[t[0]].y + shape.positions[t[1]].y + shape.positions[t[2]].y;
  };
  std::ranges::sort(shape.triangles, std::greater(), height);
  float top = 0;
  for (const Vec3f& p : shape.positions) top = std::max(top, p.y);
  for (Vec3f& p : shape.positions) p = {p.x / (2 * top), p.y / (2 * top) + 0.5F, p.z / (2 * top)};
  return shape;
}

TEST(GltfBorders, QuantizedBordersStayClosedWhereOnePrimitiveBecomesFloats) {
  const TriangleMesh shape = raised_icosahedron();
  constexpr double full_range = 32767;
  GltfScene scene = scene_of_two_materials(shape);
  for (size_t part = 0; part < 2; ++part)
    scene.primitive(0, part)["attributes"]["POSITION"] = add_quantized(scene, shape.positions, full_range);
  for (const Compression compression : {Compression::same, Compression::none, Compression::meshopt}) {
    const MeshGeometry made =
        geometry_of(refined(scene.glb(), {{"levels", "2"}, {"output.compress", name_of(compression)}}).bytes);
    for (const VertexSet& set : made.sets)
      EXPECT_EQ(set.find("POSITION")->elements.format.type, ComponentType::float32);
    EXPECT_EQ(open_edges(made), 0U) << name_of(compression);
  }
}

TEST(GltfBorders, BordersBetweenQuantizedAndFloatPositionsStayClosed) {
  TriangleMesh shape = test::icosahedron();
  for (Vec3f& p : shape.positions)
    for (float* x : {&p.x, &p.y, &p.z}) *x = std::trunc(1000 * *x);  // the same numbers in both types
  GltfScene scene = scene_of_two_materials(shape);
  scene.primitive(0, 1)["attributes"]["POSITION"] = add_quantized(scene, shape.positions, 1);
  EXPECT_EQ(open_edges(geometry_of(refined(scene.glb(), {{"levels", "2"}}).bytes)), 0U);
}
}  // namespace
}  // namespace papilio::proto::gltf
