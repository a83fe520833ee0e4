#include "client/mesh_file/formats.h"
#include "client/mesh_file/obj_file.h"
#include "tests/support/mesh_file_fixture.h"

// `mtllib` and `usemtl` of OBJ files.

namespace papilio::client {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

ObjMaterials materials_of_obj(const std::string& faces) {
  return parse_obj_file("in.obj", std::string(kThree) + "v 1 1 0\n" + faces).materials;
}

TEST(ObjMaterials, FacesHaveTheLatestName) {
  const ObjMaterials found = materials_of_obj(
      "f 1 2 3\nusemtl red\nf 1 2 3\nusemtl  wide green \r\nf 1 2 4 3\nusemtl none is used\nusemtl red\nf 1 2 3\n");
  EXPECT_THAT(found.names, ElementsAre("red", "wide green"));
  EXPECT_THAT(found.of_triangle, ElementsAre(none, 0, 1, 1, 0));
}

TEST(ObjMaterials, NamesMayBeEmpty) {
  const ObjMaterials found = materials_of_obj("usemtl\nf 1 2 3\n");
  EXPECT_THAT(found.names, ElementsAre(""));
  EXPECT_THAT(found.of_triangle, ElementsAre(0));
}

TEST(ObjMaterials, FileWithoutNamesHasNoMaterials) {
  const ObjMaterials found = materials_of_obj("mtllib a.mtl\nf 1 2 3\n");
  EXPECT_THAT(found.libraries, ElementsAre("a.mtl"));
  EXPECT_THAT(found.names, IsEmpty());
  EXPECT_THAT(found.of_triangle, IsEmpty());
}

TEST(ObjMaterials, RepeatedLibrariesAreListedOnce) {
  EXPECT_THAT(materials_of_obj("mtllib a.mtl b.mtl\nmtllib my c.mtl\nmtllib a.mtl b.mtl\nmtllib\nf 1 2 3\n").libraries,
              ElementsAre("a.mtl b.mtl", "my c.mtl"));
}

TEST(ObjMaterials, TrianglesOfPolygonsHaveTheFacesMaterial) {
  // A concave polygon, which is triangulated by ear clipping.
  const std::string text =
      "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nusemtl a\nf 1 2 3 4 5\nusemtl b\nf 1 2 3\nusemtl a\nf 1 2 3\n";
  EXPECT_THAT(parse_obj_file("in.obj", text).materials.of_triangle, ElementsAre(0, 0, 0, 1, 0));
}

TEST(ObjMaterials, TooManyMaterialsAreRefused) {
  std::string text(kThree);
  for (size_t i = 0; i <= most_materials; ++i) text += "usemtl " + std::to_string(i) + "\nf 1 2 3\n";
  EXPECT_THAT([&] { (void)parse_obj_file("in.obj", text); },
              testing::ThrowsMessage<FileError>(HasSubstr("in.obj: line 131077: there are more than 65536 materials")));
}

TEST(ObjMaterials, FacesOfOneMaterialAreWrittenTogether) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}, {0, 2, 1}, {1, 2, 3}}};
  const ObjMaterials materials{.libraries = {"a b.mtl"}, .names = {"x", "y"}, .of_triangle = {1, 0, none, 1}};
  const std::string text = encode_obj("out.obj", mesh, {}, materials);
  EXPECT_THAT(text, HasSubstr("\nmtllib a b.mtl\nv "));
  EXPECT_THAT(text, testing::EndsWith("\nf 1 3 2\nusemtl x\nf 2 4 3\nusemtl y\nf 1 2 3\nf 2 3 4\n"));
  const ObjFile back = parse_obj_file("out.obj", text);
  EXPECT_THAT(back.materials.names, ElementsAre("x", "y"));
  EXPECT_THAT(back.materials.of_triangle, ElementsAre(none, 0, 1, 1));
}

TEST(ObjMaterials, SmoothingGroupsAndMaterialsRoundTrip) {
  const std::string text =
      std::string(kThree) + "v 1 1 0\nusemtl a\ns 1\nf 1 2 3\nusemtl b\nf 2 4 3\nusemtl a\ns off\nf 1 3 2\n";
  const ObjFile file = parse_obj_file("in.obj", text);
  const ObjFile back = parse_obj_file("in.obj", encode_obj("in.obj", file.mesh, file.mesh.format, file.materials));
  ASSERT_EQ(back.mesh.attributes.size(), 1U);
  const auto groups_of = [](const ObjFile& of) {
    std::multiset<std::pair<uint32_t, bool>> found;  // material, and whether the group is off
    for (size_t t = 0; t < of.mesh.triangles.size(); ++t)
      found.insert({of.materials.of_triangle[t], of.mesh.attributes[0].values[of.mesh.triangles[t][0]] == 0});
    return found;
  };
  EXPECT_EQ(groups_of(back), groups_of(file));
}

}  // namespace
}  // namespace papilio::client
