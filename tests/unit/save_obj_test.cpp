#include "client/lib/save_obj.h"

#include "client/lib/read_materials.h"
#include "proto/draco_reader.h"
#include "proto/gltf/flattening.h"
#include "proto/gltf/material_attribute.h"
#include "proto/refinement.h"
#include "tests/support/images.h"
#include "tests/support/mesh_file_fixture.h"
#include "tests/support/shapes.h"

namespace papilio::client {
namespace {

using proto::gltf::add_material_attribute;
using proto::gltf::take_material_attribute;

using proto::gltf::Image;
using proto::gltf::ImageUse;
using proto::gltf::Material;
using proto::gltf::MaterialMesh;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

/// An icosahedron of two materials and of none, with texture coordinates.
MaterialMesh painted_icosahedron() {
  MaterialMesh model{.mesh = {test::icosahedron(), {}}};
  Attribute& attribute = model.mesh.attributes.emplace_back();
  attribute.components = 2;
  for (int i = 0; i < 24; ++i) attribute.values.push_back(i / 32.0);
  model.mesh.format.attributes = {{.kind = proto::AttributeKind::tex_coord, .id = 1}};
  model.materials.images = {{"wood", "image/png", test::png_bytes("wood"), ""},
                            {"", "image/jpeg", test::jpeg_bytes("glow"), ""}};
  Material wood{.name = "fine wood",
                .base_color = {0.1, 1.0 / 3, 0.8F, 0.5},
                .is_blended = true,
                .emissive = {1, 2, 3},
                .metallic = 0.25,
                .roughness = 0.7F};
  wood.image(ImageUse::base_color) = 0;
  wood.image(ImageUse::normal) = 0;
  wood.image(ImageUse::emissive) = 1;
  Material metal{.name = "metal", .metallic = 1, .roughness = 0};
  metal.image(ImageUse::metallic_roughness) = 0;
  model.materials.materials = {wood, metal};
  for (uint32_t t = 0; t < 20; ++t) model.materials.of_triangle.push_back(t < 5 ? none : t % 2);
  return model;
}

class SaveObj : public MeshFileTest {
 protected:
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(path(""))) found.push_back(entry.path().filename().string());
    return found;
  }
  [[nodiscard]] MaterialRead read_back(const std::string& name) const {
    const MeshPlace place{.path = path(name)};
    return read_with_materials(place, read_mesh(place));
  }
};

TEST_F(SaveObj, MaterialsRoundTripThroughScenesAndObjFiles) {
  const MaterialMesh model = painted_icosahedron();
  const std::string glb = proto::gltf::scene_of_mesh(model.mesh, model.materials);
  put("in.glb", glb);
  save_obj({.path = path("out.obj")}, read_back("in.glb").model);
  EXPECT_THAT(names(), UnorderedElementsAre("in.glb", "out.obj", "out.mtl", "out_wood.png", "out_1.jpg"));
  const MaterialRead obj = read_back("out.obj");
  EXPECT_THAT(obj.warnings, IsEmpty());
  put("back.glb", proto::gltf::scene_of_mesh(obj.model.mesh, obj.model.materials));
  const MaterialMesh back = read_back("back.glb").model;
  ASSERT_EQ(back.materials.materials.size(), 2U);
  for (size_t m = 0; m < 2; ++m) {
    Material before = model.materials.materials[m];
    Material after = back.materials.materials[m];
    for (size_t use = 0; use < proto::gltf::image_use_count; ++use) {
      ASSERT_EQ(after.images[use].has_value(), before.images[use].has_value());
      if (!after.images[use]) continue;
      EXPECT_EQ(back.materials.images[*after.images[use]].bytes, model.materials.images[*before.images[use]].bytes);
      EXPECT_EQ(back.materials.images[*after.images[use]].media_type,
                model.materials.images[*before.images[use]].media_type);
    }
    for (size_t c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(after.emissive[c], before.emissive[c]);
    before.emissive = after.emissive = {};
    before.images = after.images = {};
    EXPECT_EQ(after, before);
  }
  const auto count = [&](uint32_t material) { return std::ranges::count(back.materials.of_triangle, material); };
  EXPECT_EQ(count(none), 5);
  EXPECT_EQ(count(0), 7);
  EXPECT_EQ(count(1), 8);
  BuildReport found;
  (void)build_mesh(back.mesh, &found);
  EXPECT_EQ(found.boundary_edges, 0U);
}

TEST_F(SaveObj, MeshWithoutMaterialsHasNoLibrary) {
  save_obj({.path = path("out.obj")}, {.mesh = {tetrahedron(), {}}});
  EXPECT_THAT(names(), ElementsAre("out.obj"));
  EXPECT_THAT(read_bytes(path("out.obj"), kMaxFileBytes), testing::Not(HasSubstr("mtl")));
}

TEST_F(SaveObj, NamesAreMadeSafeAndUnique) {
  MaterialMesh model = painted_icosahedron();
  model.materials.images[0].name = "../../wood.png";
  model.materials.images[1].name = "..";
  model.materials.materials[0].name = "a\nf 1 2 3";
  model.materials.materials[1].name = "a_f 1 2 3";
  save_obj({.path = path("my out#.obj")}, model);
  EXPECT_THAT(names(), UnorderedElementsAre("my out#.obj", "my_out_.mtl", "my_out__wood.png", "my_out____.jpg"));
  const MaterialRead back = read_back("my out#.obj");
  EXPECT_THAT(back.warnings, IsEmpty());
  EXPECT_EQ(back.model.materials.materials[0].name, "a_f 1 2 3");
  EXPECT_EQ(back.model.materials.materials[1].name, "a_f 1 2 3_2");
  EXPECT_EQ(back.model.materials.images.size(), 2U);
}

TEST_F(SaveObj, FailedWriteRemovesAllNewFiles) {
  fs::create_directory(path("out.obj"));
  EXPECT_THROW(save_obj({.path = path("out.obj")}, painted_icosahedron()), FileError);
  EXPECT_THAT(names(), ElementsAre("out.obj"));
  fs::remove(path("out.obj"));
  fs::create_directory(path("out.mtl"));
  EXPECT_THROW(save_obj({.path = path("out.obj")}, painted_icosahedron()), FileError);
  EXPECT_THAT(names(), ElementsAre("out.mtl"));
}

TEST_F(SaveObj, OpaqueMaterialsHaveNoTransparency) {
  MaterialMesh model = painted_icosahedron();
  model.materials.materials[0].is_blended = false;
  save_obj({.path = path("out.obj")}, model);
  EXPECT_EQ(read_back("out.obj").model.materials.materials[0].base_color[3], 1);
  EXPECT_THAT(read_bytes(path("out.mtl"), kMaxFileBytes), testing::Not(HasSubstr("map_d")));
}

TEST(MaterialAttribute, MaterialsAreKeptByRefinement) {
  const MaterialMesh model = painted_icosahedron();
  const std::string draco = draco_of("in.obj", model);
  const auto made = proto::Refinement(draco, proto::parse_query({{"levels", "2"}}), own_limits).run();
  proto::FormattedMesh fine = proto::read_draco(made.bytes, own_limits);
  const std::vector<uint32_t> of_triangle = take_material_attribute(fine, 2);
  EXPECT_EQ(fine.attributes.size(), 1U);
  EXPECT_EQ(std::ranges::count(of_triangle, none), 16 * 5);
  EXPECT_EQ(std::ranges::count(of_triangle, 0U), 16 * 7);
  EXPECT_EQ(std::ranges::count(of_triangle, 1U), 16 * 8);
  BuildReport found;
  (void)build_mesh(fine, &found);
  EXPECT_EQ(found.boundary_edges, 0U);
}

TEST(MaterialAttribute, SurfaceDoesNotDependOnMaterials) {
  MaterialMesh model = painted_icosahedron();
  model.mesh.attributes.clear();
  model.mesh.format.attributes.clear();
  const auto positions_of = [](const MaterialMesh& of) {
    const std::string draco = draco_of("in.obj", of);
    const auto made = proto::Refinement(draco, proto::parse_query({{"tolerance", "0.01"}}), own_limits).run();
    const proto::FormattedMesh fine = proto::read_draco(made.bytes, own_limits);
    std::multiset<std::array<float, 3>> corners;
    for (const Triangle& triangle : fine.triangles)
      for (const uint32_t v : triangle) corners.insert({fine.positions[v].x, fine.positions[v].y, fine.positions[v].z});
    return corners;
  };
  EXPECT_EQ(positions_of(model), positions_of({.mesh = model.mesh}));
}

TEST(MaterialAttribute, NumbersOutOfRangeAreNoMaterial) {
  MaterialMesh model = painted_icosahedron();
  add_material_attribute(model);
  proto::FormattedMesh mesh = model.mesh;
  const std::vector<uint32_t> found = take_material_attribute(mesh, 1);
  EXPECT_EQ(std::ranges::count(found, 0U), 7);
  EXPECT_EQ(std::ranges::count(found, none), 13);
  EXPECT_EQ(take_material_attribute(mesh, 1), std::vector<uint32_t>(20, none));
}

}  // namespace
}  // namespace papilio::client
