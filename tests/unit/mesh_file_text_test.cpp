#include "tests/support/mesh_file_fixture.h"

// Dialects of OBJ and OFF, and damaged files.

namespace papilio::client {
namespace {

using testing::ElementsAre;

TEST_F(MeshFileTest, ObjCornersOfAllFormsAreRead) {
  const std::string vertices(kThree);
  for (const std::string face : {"f 1 2 3", "f 1/4 2/5 3/6", "f 1//4 2//5 3//6", "f 1/4/7 2/5/8 3/6/9", "f -3 -2 -1",
                                 "f -3/-1/-2 -2//-1 -1/-1", "f\t1  2 \\\n3", "f 1 2 \\\r\n 3 # three", "f +1 2/ 3//"})
    EXPECT_THAT(read(Format::obj, vertices + face).triangles, ElementsAre(Triangle{0, 1, 2})) << face;
}

TEST_F(MeshFileTest, NegativeObjCornersCountFromTheLatestVertex) {
  const std::string text = std::string(kThree) + "f -3 -2 -1\nv 1 1 0\nf -3 -1 -2\n";
  EXPECT_THAT(read(Format::obj, text).triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{1, 3, 2}));
}

TEST_F(MeshFileTest, ObjFacesMayPrecedeVertices) {
  EXPECT_THAT(read(Format::obj, "f 1 2 3\n" + std::string(kThree)).triangles, ElementsAre(Triangle{0, 1, 2}));
}

TEST_F(MeshFileTest, OtherObjKeywordsAreSkipped) {
  const std::string text =
      "# made by hand\r\n\r\nmtllib /dev/zero\r\no thing\r\ng a b\r\nv 0 0 0 1.0\r\nv 1 0 0 0.5 0.5 0.5\r\nv "
      "0 1 0\r\n"
      "vt 0 0\r\nvn 0 0 1\r\nusemtl none\r\ns off\r\nl 1 2\r\nf 1 2 3\r\n";
  EXPECT_EQ(read(Format::obj, text), (TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}));
}

TEST_F(MeshFileTest, Utf8ByteOrderMarkIsSkipped) {
  const TriangleMesh expected{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const std::string mark = "\xef\xbb\xbf";
  EXPECT_EQ(read(Format::obj, mark + std::string(kThree) + "f 1 2 3\n"), expected);
  EXPECT_EQ(read(Format::off, mark + "OFF\n" + std::string(kOffBody)), expected);
  EXPECT_EQ(read(Format::off, mark + std::string(kOffBody)), expected);
  EXPECT_EQ(read(Format::stl, mark + std::string(kStlText)), expected);
  EXPECT_EQ(read(Format::ply, mark + ply_header("ascii", kXyz, kIndices) + kPlyText), expected);
  const std::string binary_ply = ply_header("binary_little_endian", kXyz, kIndices) + std::string(36, '\0') + "\3" +
                                 std::string({0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0});
  EXPECT_EQ(read(Format::ply, mark + binary_ply), read(Format::ply, binary_ply));
  EXPECT_THAT(complaint(Format::obj, mark + std::string(kThree) + "f 1 2 4\n"), HasSubstr("vertex 3"));
  EXPECT_NE(complaint(Format::obj, mark), "");
}

TEST_F(MeshFileTest, OtherUnicodeEncodingsAreRefusedByName) {
  const auto widened = [](std::string_view text, const std::string& before, const std::string& after) {
    std::string wide;
    for (const char c : text) wide += before + c + after;
    return wide;
  };
  const std::string zero(1, '\0'), zeros(3, '\0');
  for (const auto& [format, text] : {std::pair{Format::obj, std::string(kThree) + "f 1 2 3\n"},
                                     {Format::off, "OFF\n" + std::string(kOffBody)},
                                     {Format::stl, std::string(kStlText)},
                                     {Format::ply, ply_header("ascii", kXyz, kIndices) + kPlyText}}) {
    EXPECT_THAT(complaint(format, "\xff\xfe" + widened(text, "", zero)), HasSubstr("UTF-16 text; save it as UTF-8"));
    EXPECT_THAT(complaint(format, "\xfe\xff" + widened(text, zero, "")), HasSubstr("UTF-16 text; save it as UTF-8"));
    EXPECT_THAT(complaint(format, "\xff\xfe" + zero + zero + widened(text, "", zeros)), HasSubstr("UTF-32 text"));
    EXPECT_THAT(complaint(format, zero + zero + "\xfe\xff" + widened(text, zeros, "")), HasSubstr("UTF-32 text"));
  }
}

TEST_F(MeshFileTest, ConcavePolygonsAreCutInside) {
  const std::string arrow = "0 0 0\n4 2 0\n0 4 0\n1 2 0\n";
  const auto inside = ElementsAre(Triangle{0, 1, 3}, Triangle{1, 2, 3});
  EXPECT_THAT(read(Format::obj, "v 0 0 0\nv 4 2 0\nv 0 4 0\nv 1 2 0\nf 1 2 3 4\n").triangles, inside);
  EXPECT_THAT(read(Format::obj, "f 1 2 3 4\nv 0 0 0\nv 4 2 0\nv 0 4 0\nv 1 2 0\n").triangles, inside);
  EXPECT_THAT(read(Format::off, "OFF\n4 1 0\n" + arrow + "4 0 1 2 3\n").triangles, inside);
  const std::string vertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_index\n";
  const std::string ply = "ply\nformat ascii 1.0\n";
  EXPECT_THAT(read(Format::ply, ply + vertices + faces + "end_header\n" + arrow + "4 0 1 2 3\n").triangles, inside);
  EXPECT_THAT(read(Format::ply, ply + faces + vertices + "end_header\n4 0 1 2 3\n" + arrow).triangles, inside);
  EXPECT_THAT(read(Format::stl,
                   "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 4 2 0\nvertex 0 4 0\n"
                   "vertex 1 2 0\nendloop\nendfacet\nendsolid s\n")
                  .triangles,
              inside);
}

TEST_F(MeshFileTest, NumbersAreReadAsTheNearestFloat) {
  const TriangleMesh mesh =
      read(Format::obj, "v 0.1 1e-60 -1e-400\nv 16777217.000001 +.5 1e-45\nv nan inf -inf\nf 1 2 3\n");
  EXPECT_EQ(mesh.positions[0], (Vec3f{0.1F, 0, 0}));
  EXPECT_EQ(mesh.positions[1], (Vec3f{16777218, 0.5F, std::numeric_limits<float>::denorm_min()}));
  EXPECT_TRUE(std::isnan(mesh.positions[2].x));
  EXPECT_THAT(complaint(Format::obj, "v 0 0 0\nv 1e39 0 0\nv 0 1 0\nf 1 2 3\n"),
              HasSubstr("line 2: expected a number"));
}

TEST_F(MeshFileTest, DamagedObjIsRefused) {
  const std::string vertices(kThree);
  for (const std::string damage :
       {"f 1 2 4", "f 0 1 2", "f -4 1 2", "f 1 2", "f 1 2 x3", "f 1.5 2 3", "f /1/2 2 3", "f 1 2 99999999999999999999",
        "f 1 2 4294967297", "f 1,2,3", "v 1 2", "v 1 2 x", "v", "f", "f 1 2 3/x", "", "f 1 2 3\nv 1e39 0 0"})
    EXPECT_NE(complaint(Format::obj, vertices + damage + "\n"), "") << damage;
  EXPECT_NE(complaint(Format::obj, std::string("v 0 0 0\0f 1 1 1\n", 16)), "");
  EXPECT_THAT(complaint(Format::obj, vertices + "\nf 1 2 bad\n"),
              HasSubstr("line 5: expected the number of a vertex, found 'bad'; export the mesh again"));
}

TEST_F(MeshFileTest, OffDialectsAreRead) {
  const TriangleMesh expected{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  for (const std::string& text : {
           "OFF\n" + std::string(kOffBody),
           "OFF " + std::string(kOffBody),
           std::string(kOffBody),
           "# made by hand\n\nOFF # really\r\n# counts\r\n" + std::string(kOffBody) + "\n# the end\n",
           std::string("OFF\n3 1\n0 0 0\n1 0 0\n\n\n0 1 0\n3 0 1 2 255 0 0"),
           std::string("COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 255 0 255\n0 1 0 0 0 255 255\n3 0 1 2 0.5 0.5 0.5\n"),
           std::string("STCNOFF\n3 1 0\n0 0 0 0 0 1 1 0 0 1 0 0\n1 0 0 0 0 1 1 0 0 1 0 0\n0 1 0 0 0 1 1 0 0 1 0 0\n"
                       "3 0 1 2\n"),
           std::string("OFF\n3 3 0\n0 0 0\n1 0 0\n0 1 0\n1 0\n3 0 1 2\n2 0 1\n"),
       })
    EXPECT_EQ(read(Format::off, text), expected) << text;
}

TEST_F(MeshFileTest, DamagedOffIsRefused) {
  for (const std::string text :
       {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n",
        "OFF\n3 4000000000 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "OFF\n4000000000 1 0\n0 0 0\n",
        "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0", "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "OFF\n2 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "OFF\n", "OFF",
        "OFF\n-3 1 0\n", "OFF BINARY\nxxxx", "4OFF\n1 0 0\n0 0 0 0\n", "nOFF\n3\n1 0 0\n0 0 0\n", "hello\n",
        "OFF\n3 1 0\n0 0\n1 0 0\n"})
    EXPECT_NE(complaint(Format::off, text), "") << text;
}

TEST_F(MeshFileTest, OffWithTrailingFacesIsRefused) {
  EXPECT_THAT(complaint(Format::off, "OFF\n" + std::string(kOffBody) + "3 2 1 0\n"),
              HasSubstr("line 7: the file goes on"));
}

}  // namespace
}  // namespace papilio::client
