#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "proto/gltf/vertices.h"
#include "tests/support/gltf_refinement.h"
#include "tests/support/shapes.h"

namespace papilio::proto::gltf {
namespace {

using test::geometry_of;
using test::GltfScene;
using test::refined;

TEST(GltfMorph, MorphTargetsMoveTheirNewVertices) {
  GltfScene scene;
  scene.add_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  const size_t target = scene.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 2, 0, 0, 4}, "VEC3");
  scene.primitive()["targets"] = {{{"POSITION", target}}};
  const MeshGeometry made = geometry_of(refined(scene.glb(), {{"levels", "2"}}).bytes);
  const Buffer<Vec3f> positions = vertex_positions(made.sets[0]);
  ASSERT_EQ(made.sets[0].count, 15U);
  ASSERT_EQ(made.sets[0].targets.size(), 1U);
  for (uint32_t i = 0; i < 15; ++i)
    EXPECT_NEAR(made.sets[0].targets[0][0].elements.number(i, 2), 1 + positions[i].x + 3 * positions[i].y, 1e-6);
}

TEST(GltfMorph, AnyWeightOfAMorphTargetGivesTheRefinedMorph) {
  const TriangleMesh shape = test::torus(9, 7);
  const auto scene_of = [&](float weight) {
    Buffer<Vec3f> positions = shape.positions;
    std::vector<float> displacements, normals(3 * positions.size(), 0);
    for (size_t i = 0; i < positions.size(); ++i) {
      const Vec3f p = shape.positions[i];
      const Vec3f d{0.2F * p.y * p.z, 0.3F * p.x, -0.1F * p.x * p.y};
      displacements.insert(displacements.end(), {d.x, d.y, d.z});
      positions[i] += weight * d;
      const float ring = std::hypot(p.x, p.y);  // radius 1 about z
      const Vec3f out{p.x - p.x / ring, p.y - p.y / ring, p.z};
      normals[3 * i] = out.x / length(out);
      normals[3 * i + 1] = out.y / length(out);
      normals[3 * i + 2] = out.z / length(out);
    }
    GltfScene scene;
    scene.add_mesh({positions, shape.triangles});
    scene.primitive()["attributes"]["NORMAL"] = scene.add_accessor(normals, "VEC3");
    scene.primitive()["targets"] = {
        {{"POSITION", scene.add_accessor(displacements, "VEC3")}, {"NORMAL", scene.add_accessor(normals, "VEC3")}}};
    return geometry_of(refined(scene.glb(), {{"levels", "2"}, {"tension", "off"}}).bytes);
  };
  const MeshGeometry base = scene_of(0);
  for (const float weight : {1.0F, 0.3F, -2.0F}) {
    const MeshGeometry moved = scene_of(weight);
    ASSERT_EQ(moved.sets[0].count, base.sets[0].count);
    const Buffer<Vec3f> from = vertex_positions(base.sets[0]);
    const Buffer<Vec3f> to = vertex_positions(moved.sets[0]);
    const auto& target = base.sets[0].targets.at(0);
    const auto number = [](const VertexStream& stream, size_t i) {
      return Vec3d{stream.elements.number(i, 0), stream.elements.number(i, 1), stream.elements.number(i, 2)};
    };
    for (size_t i = 0; i < from.size(); ++i) {
      EXPECT_LT(length(to_double(from[i]) + double{weight} * number(target[0], i) - to_double(to[i])), 1e-6);
      if (weight != 1) continue;
      const Vec3d normal = number(*base.sets[0].find("NORMAL"), i) + number(target[1], i);
      EXPECT_LT(length(normal - number(*moved.sets[0].find("NORMAL"), i)), 1e-4);
    }
  }
}

TEST(GltfMorph, OverflowingQuantizedDisplacementsBecomeFloats) {
  const TriangleMesh shape = test::icosahedron();
  GltfScene scene;
  scene.add_mesh(shape);
  std::vector<int8_t> displacements;  // VEC3 of bytes, padded to four
  for (size_t i = 0; i < shape.positions.size(); ++i) {
    const auto large = static_cast<int8_t>(i % 2 == 0 ? 127 : -127);
    displacements.insert(displacements.end(), {large, 0, large, 0});
  }
  const size_t view = scene.add_view({reinterpret_cast<const char*>(displacements.data()), displacements.size()});
  scene.json["bufferViews"][view]["byteStride"] = 4;
  scene.json["accessors"].push_back({{"bufferView", view},
                                     {"componentType", 5120},
                                     {"normalized", true},
                                     {"count", shape.positions.size()},
                                     {"type", "VEC3"}});
  scene.json["extensionsUsed"] = {"KHR_mesh_quantization"};
  scene.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  scene.primitive()["targets"] = {{{"POSITION", scene.json["accessors"].size() - 1}}};
  const MeshGeometry made = geometry_of(refined(scene.glb(), {{"levels", "2"}, {"tension", "off"}}).bytes);
  const Elements& target = made.sets[0].targets.at(0).at(0).elements;
  EXPECT_EQ(target.format.type, ComponentType::float32);
  double most = 0;
  for (uint64_t i = 0; i < target.count; ++i) most = std::max(most, std::abs(target.number(i, 0)));
  EXPECT_GT(most, 1.0);
  EXPECT_LT(most, 1.5);
}

}  // namespace
}  // namespace papilio::proto::gltf
