#include "client/lib/material_library.h"

#include "client/lib/read_materials.h"
#include "proto/gltf/flattening.h"
#include "tests/support/gltf_scene.h"
#include "tests/support/images.h"
#include "tests/support/mesh_file_fixture.h"

namespace papilio::client {
namespace {

using proto::gltf::ImageUse;
using proto::gltf::Material;
using proto::gltf::Materials;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::string_view textured_square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

/// A square whose two triangles have materials.
class MaterialLibrary : public MeshFileTest {
 protected:
  /// Reads in.obj with these libraries; its faces have the materials `a` and `b`.
  MaterialRead read_square(const std::string& libraries) {
    put("in.obj",
        libraries + "\n" + std::string(textured_square) + "usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 3/3 4/4\n");
    const MeshPlace place{.path = path("in.obj")};
    return read_with_materials(place, read_mesh(place));
  }
  void put_below(const std::string& folder, const std::string& name, const std::string& bytes) {
    fs::create_directory(path(folder));
    put(folder + "/" + name, bytes);
  }
  std::string image_bytes(const MaterialRead& read, size_t material, ImageUse use) {
    const Materials& materials = read.model.materials;
    const auto image = materials.materials.at(material).image(use);
    return image ? materials.images.at(*image).bytes : "";
  }
};

TEST_F(MaterialLibrary, ValuesAreConvertedToGltf) {
  put("a.mtl",
      "newmtl a\nKd 0.1 0.2 0.3\nd 0.5\nKe 4 5 6\nPr 0.25\nPm 0.75\nnewmtl unused\nmap_Kd missing.png\nnewmtl b\n");
  const MaterialRead read = read_square("mtllib a.mtl");
  EXPECT_THAT(read.warnings, IsEmpty());
  const Material a{.name = "a",
                   .base_color = {0.1, 0.2, 0.3, 0.5},
                   .is_blended = true,
                   .emissive = {4, 5, 6},
                   .metallic = 0.75,
                   .roughness = 0.25};
  EXPECT_THAT(read.model.materials.materials, ElementsAre(a, Material{.name = "b", .metallic = 0, .roughness = 1}));
  EXPECT_THAT(read.model.materials.of_triangle, ElementsAre(0, 1));
}

TEST_F(MaterialLibrary, RoughnessFollowsFromTheExponent) {
  put("a.mtl", "newmtl a\nNs 6\nnewmtl b\nNs 0\n");
  const Materials found = read_square("mtllib a.mtl").model.materials;
  EXPECT_EQ(found.materials[0].roughness, 0.5);
  EXPECT_EQ(found.materials[1].roughness, 1);
}

TEST_F(MaterialLibrary, ImagesAreReadOnceByTheirContent) {
  put("wood.tga", test::png_bytes("wood"));
  put_below("maps", "my glow.jpg", test::jpeg_bytes("glow"));
  put("a.mtl",
      "newmtl a\nmap_Kd -s 1 1 1 .\\wood.tga\nmap_Ke maps\\my glow.jpg\nnewmtl b\nmap_Kd wood.tga\nnorm ./wood.tga\n");
  const MaterialRead read = read_square("mtllib a.mtl");
  EXPECT_THAT(read.warnings, IsEmpty());
  const Materials& found = read.model.materials;
  ASSERT_EQ(found.images.size(), 2U);
  EXPECT_EQ(found.images[0], (proto::gltf::Image{"wood", "image/png", test::png_bytes("wood"), ""}));
  EXPECT_EQ(found.images[1], (proto::gltf::Image{"my glow", "image/jpeg", test::jpeg_bytes("glow"), ""}));
  EXPECT_EQ(found.materials[0].image(ImageUse::base_color), 0U);
  EXPECT_EQ(found.materials[0].image(ImageUse::emissive), 1U);
  EXPECT_EQ(found.materials[0].emissive, (std::array<double, 3>{1, 1, 1}));  // default with an image
  EXPECT_EQ(found.materials[1].image(ImageUse::base_color), 0U);
  EXPECT_EQ(found.materials[1].image(ImageUse::normal), 0U);
}

TEST_F(MaterialLibrary, SeveralLibrariesAreSearchedInOrder) {
  put("my lib.mtl", "newmtl b\nKd 1 0 0\n");
  put("one.mtl", "newmtl a\nKd 0 1 0\n");
  put("two.mtl", "newmtl a\nKd 0 0 1\nnewmtl b\nKd 0 0 1\n");
  const MaterialRead read = read_square("mtllib my lib.mtl\nmtllib one.mtl two.mtl");
  EXPECT_THAT(read.warnings, IsEmpty());
  EXPECT_EQ(read.model.materials.materials[0].base_color, (std::array<double, 4>{0, 1, 0, 1}));
  EXPECT_EQ(read.model.materials.materials[1].base_color, (std::array<double, 4>{1, 0, 0, 1}));
}

TEST_F(MaterialLibrary, MissingLibraryIsSkippedWithAWarning) {
  const MaterialRead read = read_square("mtllib no.mtl");
  EXPECT_TRUE(read.model.materials.empty());
  EXPECT_EQ(read.model.mesh.triangles.size(), 2U);
  EXPECT_THAT(read.warnings,
              ElementsAre(HasSubstr("in.obj: names the material library \"no.mtl\", which is not there")));
}

TEST_F(MaterialLibrary, MissingImageIsSkippedWithOneWarning) {
  put("a.mtl", "newmtl a\nmap_Kd no.png\nnewmtl b\nmap_Kd no.png\n");
  const MaterialRead read = read_square("mtllib a.mtl");
  EXPECT_FALSE(read.model.materials.materials[0].image(ImageUse::base_color));
  EXPECT_THAT(read.warnings, ElementsAre(HasSubstr("a.mtl: names the image \"no.png\", which is not there")));
}

TEST_F(MaterialLibrary, UnsupportedImagesAreSkippedWithAWarning) {
  put("wood.png", "BM not a PNG");
  put("a.mtl", "newmtl a\nmap_Kd wood.png\nnewmtl b\nmap_Bump wood.png\n");
  const MaterialRead read = read_square("mtllib a.mtl");
  EXPECT_THAT(read.warnings, ElementsAre(HasSubstr("wood.png: is neither a PNG nor a JPEG image"),
                                         HasSubstr("the bump map \"wood.png\" is left out")));
  EXPECT_THAT(read.model.materials.images, IsEmpty());
}

TEST_F(MaterialLibrary, UndefinedMaterialsAreWhite) {
  put("a.mtl", "newmtl b\nKd 0 0 0\n");
  const MaterialRead read = read_square("mtllib a.mtl");
  EXPECT_EQ(read.model.materials.materials[0], (Material{.name = "a", .metallic = 0, .roughness = 1}));
  EXPECT_THAT(read.warnings, ElementsAre(HasSubstr("in.obj: has 1 material that no library defines, \"a\"")));
}

TEST_F(MaterialLibrary, PathsOutsideTheFolderAreNotRead) {
  put("secret.mtl", "newmtl a\nKd 0 0 0\n");
  put("secret.png", test::png_bytes("secret"));
  put_below("inner", "in.obj",
            "mtllib ../secret.mtl\nmtllib a.mtl\n" + std::string(textured_square) + "usemtl b\nf 1/1 2/2 3/3\n");
  put("inner/a.mtl", "newmtl b\nmap_Kd ..\\secret.png\nmap_Ke " + path("secret.png").string() + "\n");
  const MeshPlace place{.path = path("inner/in.obj")};
  const MaterialRead read = read_with_materials(place, read_mesh(place));
  EXPECT_THAT(read.model.materials.images, IsEmpty());
  EXPECT_THAT(
      read.warnings,
      ElementsAre(HasSubstr("names the material library \"../secret.mtl\", which is not in its folder; put it there"),
                  HasSubstr("a.mtl: names the image \"../secret.png\", which is not in its folder; put it there")));
  // Images in the folder are found by their file names.
  put("inner/secret.png", test::png_bytes("public"));
  const MaterialRead again = read_with_materials(place, read_mesh(place));
  EXPECT_EQ(image_bytes(again, 0, ImageUse::base_color), test::png_bytes("public"));
  EXPECT_EQ(image_bytes(again, 0, ImageUse::emissive), test::png_bytes("public"));
}

TEST_F(MaterialLibrary, ImagesAreRelativeToTheirLibrary) {
  put_below("lib", "a.mtl", "newmtl a\nmap_Kd wood.png\nnewmtl b\nmap_Kd ../wood.png\n");
  put("lib/wood.png", test::png_bytes("inner"));
  put("wood.png", test::png_bytes("outer"));
  const MaterialRead read = read_square("mtllib lib/a.mtl");
  EXPECT_THAT(read.warnings, IsEmpty());
  EXPECT_EQ(image_bytes(read, 0, ImageUse::base_color), test::png_bytes("inner"));
  EXPECT_EQ(image_bytes(read, 1, ImageUse::base_color), test::png_bytes("outer"));
}

TEST_F(MaterialLibrary, ImagesNeedTextureCoordinates) {
  put("a.mtl", "newmtl a\nmap_Kd missing.png\n");
  put("in.obj", "mtllib a.mtl\n" + std::string(kThree) + "usemtl a\nf 1 2 3\n");
  const MeshPlace place{.path = path("in.obj")};
  const MaterialRead read = read_with_materials(place, read_mesh(place));
  EXPECT_THAT(read.warnings, IsEmpty());
  EXPECT_EQ(read.model.materials.materials.size(), 1U);
}

TEST_F(MaterialLibrary, ChannelsOfOneImageGiveRoughnessAndMetalness) {
  put("pbr.png", test::png_bytes("pbr"));
  put("a.mtl",
      "newmtl a\nmap_Pr -imfchan g pbr.png\nmap_Pm -imfchan b pbr.png\nnewmtl b\nmap_Pr pbr.png\nmap_d pbr.png\n");
  const MaterialRead read = read_square("mtllib a.mtl");
  const auto& materials = read.model.materials.materials;
  EXPECT_EQ(materials[0].image(ImageUse::metallic_roughness), 0U);
  EXPECT_EQ(materials[0].metallic, 1);
  EXPECT_FALSE(materials[1].image(ImageUse::metallic_roughness));
  EXPECT_TRUE(materials[1].is_blended);
  EXPECT_THAT(read.warnings, ElementsAre(HasSubstr("map_Pr and map_Pm are left out"), HasSubstr("map_d is left out")));
}

TEST_F(MaterialLibrary, DamagedLibrariesAreRefusedByName) {
  put("a.mtl", "newmtl a\nKd red\n");
  EXPECT_THAT([&] { (void)read_square("mtllib a.mtl"); },
              testing::ThrowsMessage<FileError>(HasSubstr("a.mtl: line 2: expected a finite number, found 'red'")));
}

TEST_F(MaterialLibrary, ImagesBesideASceneAreRead) {
  test::GltfScene scene;
  scene.add_mesh(tetrahedron());
  scene.primitive()["attributes"]["TEXCOORD_0"] = scene.add_accessor(std::vector<float>(8, 0.5F), "VEC2");
  scene.primitive()["material"] = 0;
  scene.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  scene.json["textures"] = {{{"source", 0}}};
  scene.json["images"] = {{{"uri", "wood%202.png"}}};
  const MeshPlace place{.path = put("in.glb", scene.glb())};
  EXPECT_THAT(read_with_materials(place, read_mesh(place)).warnings,
              ElementsAre(HasSubstr("wood 2.png: cannot be opened")));
  put("wood 2.png", test::png_bytes("wood"));
  EXPECT_EQ(image_bytes(read_with_materials(place, read_mesh(place)), 0, ImageUse::base_color),
            test::png_bytes("wood"));
}

}  // namespace
}  // namespace papilio::client
