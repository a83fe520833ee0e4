#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <set>

#include "proto/draco_writer.h"
#include "proto/gltf/geometry.h"
#include "proto/gltf/meshopt.h"
#include "proto/gltf/vertices.h"
#include "proto/problem.h"
#include "tests/support/gltf_scene.h"
#include "tests/support/shapes.h"

namespace papilio::proto::gltf {
namespace {

using test::GltfScene;
using Json = GltfScene::Json;

MeshGeometry geometry_of(const GltfScene& scene, const Limits& limits = {}) {
  const std::string glb = scene.glb();
  const Document document = read_document(glb);
  Views views(document);
  Allowance allowance(limits);
  return read_geometry(views, 0, allowance);
}

Code refusal_of(const GltfScene& scene, const Limits& limits = {}) {
  try {
    (void)geometry_of(scene, limits);
  } catch (const Problem& problem) {
    EXPECT_GT(std::string(problem.what()).size(), 20U);
    return problem.code();
  }
  return Code::internal;
}

TEST(GltfGeometry, PositionsAndIndicesAreRead) {
  const TriangleMesh mesh = test::icosahedron();
  GltfScene scene;
  scene.add_mesh(mesh);
  const MeshGeometry found = geometry_of(scene);
  ASSERT_EQ(found.sets.size(), 1U);
  EXPECT_EQ(vertex_positions(found.sets[0]), mesh.positions);
  ASSERT_EQ(found.primitives.size(), 1U);
  EXPECT_TRUE(std::ranges::equal(found.primitives[0].triangles, mesh.triangles));
}

TEST(GltfGeometry, StripsFansAndListsWithoutIndicesKeepTheirWinding) {
  GltfScene scene;
  scene.add_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}}, {{0, 1, 2}}});
  const auto triangles = [&](int mode, bool indexed) {
    GltfScene other = scene;
    other.primitive()["mode"] = mode;
    if (!indexed) other.primitive().erase("indices");
    return geometry_of(other).primitives.at(0).triangles;
  };
  EXPECT_EQ(triangles(5, false), (Buffer<Triangle>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
  EXPECT_EQ(triangles(6, false), (Buffer<Triangle>{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
  EXPECT_EQ(triangles(4, false), (Buffer<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(triangles(5, true), (Buffer<Triangle>{{0, 1, 2}}));
}

TEST(GltfGeometry, PointsAndLinesAreIgnored) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  for (int mode = 0; mode < 4; ++mode) {
    scene.primitive()["mode"] = mode;
    EXPECT_TRUE(geometry_of(scene).primitives.empty());
  }
  scene.primitive()["mode"] = 7;
  EXPECT_EQ(refusal_of(scene), Code::mesh_not_gltf);
}

TEST(GltfGeometry, QuantizedAndStridedPositionsAreConverted) {
  GltfScene scene;
  scene.add_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  const std::vector<int16_t> numbers{0, 1, 2, 99, -32767, -32768, 32767, 99, 3, 4, 5, 99};
  const size_t accessor = scene.add_accessor(numbers, "VEC4");
  scene.json["accessors"][accessor]["type"] = "VEC3";
  scene.json["bufferViews"].back()["byteStride"] = 8;
  scene.primitive()["attributes"]["POSITION"] = accessor;
  EXPECT_EQ(vertex_positions(geometry_of(scene).sets[0])[1], (Vec3f{-32767, -32768, 32767}));
  scene.json["accessors"][accessor]["normalized"] = true;
  EXPECT_EQ(vertex_positions(geometry_of(scene).sets[0])[1], (Vec3f{-1, -1, 1}));
}

TEST(GltfGeometry, SparseElementsReplaceElementsOfTheView) {
  GltfScene scene;
  scene.add_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  const size_t indices = scene.add_view(std::string("\2", 1));
  const std::vector<float> value{7, 8, 9};
  const size_t values = scene.add_view({reinterpret_cast<const char*>(value.data()), 12});
  Json& positions = scene.json["accessors"][0];
  positions["sparse"] = {{"count", 1},
                         {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                         {"values", {{"bufferView", values}}}};
  EXPECT_EQ(vertex_positions(geometry_of(scene).sets[0])[2], (Vec3f{7, 8, 9}));
  positions.erase("bufferView");  // zeros
  EXPECT_EQ(vertex_positions(geometry_of(scene).sets[0])[1], (Vec3f{0, 0, 0}));
  positions["count"] = 2;
  EXPECT_EQ(refusal_of(scene), Code::mesh_not_gltf);
}

TEST(GltfGeometry, PrimitivesOfEqualAttributesShareTheirVertices) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  Json second = scene.primitive();
  second["material"] = 1;
  scene.json["meshes"][0]["primitives"].push_back(second);
  const MeshGeometry found = geometry_of(scene);
  EXPECT_EQ(found.sets.size(), 1U);
  EXPECT_EQ(found.primitives.size(), 2U);
}

TEST(GltfGeometry, CountsBeyondBytesOrLimitsAreRefused) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  GltfScene other = scene;
  other.json["accessors"][0]["count"] = 13;
  EXPECT_EQ(refusal_of(other), Code::mesh_not_gltf);
  other.json["accessors"][0]["count"] = 9'000'000'000'000'000;
  EXPECT_EQ(refusal_of(other), Code::mesh_too_large);
  EXPECT_EQ(refusal_of(scene, {.max_input_faces = 19}), Code::mesh_too_large);
  EXPECT_EQ(refusal_of(scene, {.max_input_faces = 20}), Code::internal);
  other = scene;
  other.json["accessors"][0].erase("bufferView");  // zeros: no bytes bound the count
  other.json["accessors"][0]["count"] = 100'000'000;
  EXPECT_EQ(refusal_of(other), Code::mesh_too_large);
  other = scene;
  other.json["bufferViews"][0]["byteLength"] = 1'000'000;
  EXPECT_EQ(refusal_of(other), Code::mesh_not_gltf);
}

TEST(GltfGeometry, IndexOutOfRangeIsRefused) {
  GltfScene scene;
  scene.add_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}});
  EXPECT_EQ(refusal_of(scene), Code::mesh_unusable);
}

/// Replaces the view of an accessor by a compressed view.
void compress_view(GltfScene& scene, size_t accessor, const std::string& mode, size_t stride) {
  const size_t view = scene.json["accessors"][accessor]["bufferView"];
  Json& old = scene.json["bufferViews"][view];
  const size_t length = old["byteLength"];
  const std::string bytes = scene.binary.substr(old["byteOffset"].get<size_t>(), length);
  const std::string compressed = mode == "ATTRIBUTES" ? encode_meshopt_attributes(bytes, static_cast<uint32_t>(stride))
                                                      : encode_meshopt_triangles(bytes, static_cast<uint32_t>(stride));
  const size_t source = scene.add_view(compressed);
  Json extension = scene.json["bufferViews"][source];
  extension["byteStride"] = stride;
  extension["mode"] = mode;
  extension["count"] = length / stride;
  scene.json["bufferViews"].erase(source);
  scene.json["bufferViews"][view]["extensions"]["EXT_meshopt_compression"] = extension;
}

TEST(GltfGeometry, MeshoptViewsAreDecompressed) {
  const TriangleMesh mesh = test::icosahedron();
  GltfScene scene;
  scene.add_mesh(mesh);
  compress_view(scene, 0, "ATTRIBUTES", 12);
  compress_view(scene, 1, "TRIANGLES", 2);
  const MeshGeometry found = geometry_of(scene);
  EXPECT_EQ(vertex_positions(found.sets[0]), mesh.positions);
  const auto corners = [](const auto& triangles) {
    std::multiset<std::set<uint32_t>> out;
    for (const Triangle& t : triangles) out.insert({t[0], t[1], t[2]});
    return out;
  };
  EXPECT_EQ(corners(found.primitives[0].triangles), corners(mesh.triangles));

  GltfScene damaged = scene;
  Json& extension = damaged.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"];
  damaged.binary[extension["byteOffset"].get<size_t>()] = '\xA1';
  EXPECT_EQ(refusal_of(damaged), Code::mesh_unsupported);  // the newer codec
  damaged.binary[extension["byteOffset"].get<size_t>()] = 'x';
  EXPECT_EQ(refusal_of(damaged), Code::mesh_not_gltf);
  damaged = scene;
  damaged.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["count"] = 1'000'000'000;
  EXPECT_EQ(refusal_of(damaged), Code::mesh_not_gltf);
}

TEST(GltfGeometry, DracoPrimitivesAreDecompressed) {
  const TriangleMesh mesh = test::icosahedron();
  GltfScene scene;
  scene.add_mesh(mesh);
  const size_t view = scene.add_view(write_draco_exact(mesh));
  scene.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view},
                                                                   {"attributes", {{"POSITION", 0}}}};
  for (const size_t accessor : {0, 1}) scene.json["accessors"][accessor].erase("bufferView");
  const MeshGeometry found = geometry_of(scene);
  const auto sorted = [](const Buffer<Vec3f>& positions) {
    std::multiset<std::array<float, 3>> out;
    for (const Vec3f& p : positions) out.insert({p.x, p.y, p.z});
    return out;
  };
  EXPECT_EQ(sorted(vertex_positions(found.sets[0])), sorted(mesh.positions));
  EXPECT_EQ(found.primitives[0].triangles.size(), 20U);

  GltfScene wrong = scene;
  wrong.json["accessors"][0]["count"] = 13;
  EXPECT_EQ(refusal_of(wrong), Code::mesh_not_gltf);
  wrong = scene;
  wrong.primitive()["extensions"]["KHR_draco_mesh_compression"]["attributes"]["POSITION"] = 5;
  EXPECT_EQ(refusal_of(wrong), Code::mesh_not_gltf);
}

TEST(GltfGeometry, EqualVerticesHaveOneRepresentative) {
  GltfScene scene;
  scene.add_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}}, {{0, 1, 2}}});
  EXPECT_EQ(equal_vertices(geometry_of(scene).sets[0]), (std::vector<uint32_t>{0, 1, 2, 1}));
  scene.primitive()["attributes"]["COLOR_0"] =
      scene.add_accessor(std::vector<uint8_t>{0, 0, 0, 0, 1, 1, 1, 1, 0, 0, 0, 0, 2, 2, 2, 2}, "VEC4", true);
  EXPECT_EQ(equal_vertices(geometry_of(scene).sets[0]), (std::vector<uint32_t>{0, 1, 2, 3}));
}

}  // namespace
}  // namespace papilio::proto::gltf
