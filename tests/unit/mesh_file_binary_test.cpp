#include <cstring>

#include "tests/support/mesh_file_fixture.h"

// Dialects of PLY and STL, and damaged files.

namespace papilio::client {
namespace {

TEST_F(MeshFileTest, UnknownPlyElementsAndPropertiesAreSkipped) {
  const TriangleMesh expected{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  for (const auto order : {std::endian::little, std::endian::big}) {
    std::string bytes =
        "ply\r\nformat " + std::string(order == std::endian::little ? "binary_little_endian" : "binary_big_endian") +
        " 1.0\r\nelement camera 2\r\nproperty list uint16 int16 path\r\nproperty double zoom\r\nelement "
        "nothing 4000000000\r\n"
        "element vertex 3\r\nproperty uchar red\r\nproperty short y\r\nproperty double x\r\nproperty list "
        "int8 uint weights\r\n"
        "property float32 z\r\nelement face 1\r\nproperty list uchar float texcoord\r\n"
        "property list uint ushort vertex_indices\r\nproperty int flags\r\nelement edge 1\r\nproperty int "
        "vertex1\r\nend_header\r\n";
    const auto add = [&](auto number) { put_number(bytes, number, order); };
    for (int i = 0; i < 2; ++i) {
      add(uint16_t{2});
      add(int16_t{-1});
      add(int16_t{5});
      add(0.5);
    }
    for (const Vec3f& p : expected.positions) {
      add(uint8_t{255});
      add(static_cast<int16_t>(p.y));
      add(static_cast<double>(p.x));
      add(int8_t{1});
      add(uint32_t{9});
      add(p.z);
    }
    add(uint8_t{6});
    for (int i = 0; i < 6; ++i) add(0.5F);
    add(uint32_t{3});
    for (const uint16_t vertex : {0, 1, 2}) add(vertex);
    add(int32_t{1});
    add(int32_t{0});
    EXPECT_EQ(read(Format::ply, bytes), expected);
    bytes.pop_back();
    EXPECT_THAT(complaint(Format::ply, bytes), HasSubstr("cut short"));
  }
}

TEST_F(MeshFileTest, DamagedPlyIsRefused) {
  const std::string good = ply_header("ascii", kXyz, kIndices) + kPlyText;
  EXPECT_EQ(complaint(Format::ply, good), "");
  for (const std::string& text :
       {std::string("ply"), std::string("ply\n"), std::string("ply\nend_header\n"),
        std::string("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"),
        std::string("ply\nformat ascii 1.0\nproperty list uchar int vertex_indices\nend_header\n"),
        ply_header("binary_middle_endian", kXyz, kIndices),
        ply_header("ascii", "property float x\n", kIndices) + kPlyText,
        ply_header("ascii", kXyz, "property int vertex_indices_of\n") + kPlyText,
        ply_header("ascii", kXyz + "property quad q\n", kIndices) + kPlyText,
        ply_header("ascii", kXyz, "property list float int vertex_indices\n") + kPlyText,
        ply_header("ascii", kXyz, kIndices) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
        ply_header("ascii", kXyz, kIndices) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -2\n",
        ply_header("ascii", kXyz, kIndices) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 0.5\n",
        ply_header("ascii", kXyz, kIndices) + "0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n",
        ply_header("ascii", kXyz, kIndices) + "0 0 0\n1 0 zero\n0 1 0\n3 0 1 2\n",
        ply_header("ascii", "property double x\nproperty float y\nproperty float z\n", kIndices) +
            "1e300 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        good + "3 0 1 2\n", good.substr(0, good.size() - 3)})
    EXPECT_NE(complaint(Format::ply, text), "") << text;
  EXPECT_THAT(complaint(Format::ply, ply_header("ascii", kXyz, kIndices) + "0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n"),
              HasSubstr("line 13: expected a number, found 'x'"));
}

TEST_F(MeshFileTest, PlyCountsBeyondTheFileAreRefused) {
  for (const std::string format : {"ascii", "binary_little_endian"}) {
    for (const std::string element : {"vertex", "face", "thing"}) {
      const std::string text = "ply\nformat " + format + " 1.0\nelement " + element + " 4000000000\n" +
                               (element == "face" ? kIndices : kXyz) + "end_header\n0 0 0\n";
      EXPECT_THAT(complaint(Format::ply, text), HasSubstr("4000000000 elements")) << text;
    }
  }
}

TEST_F(MeshFileTest, BinaryStlMayBeginWithSolid) {
  for (const std::string header : {"", "solid", "solid facet normal 0 0 1"}) {
    const std::string bytes = binary_stl(untidy(), header);
    EXPECT_EQ(bits(read(Format::stl, bytes)), bits(soup(untidy())));
    EXPECT_EQ(read(Format::stl, bytes + "x"), soup(untidy())) << "bytes after the triangles";
    EXPECT_THAT(complaint(Format::stl, bytes.substr(0, bytes.size() - 1)), HasSubstr("cut short"));
  }
}

TEST_F(MeshFileTest, BinaryStlMayBeginWithAByteOrderMark) {
  for (const std::string header : {"\xef\xbb\xbf solid", "\xff\xfe", "\xfe\xff"})
    EXPECT_EQ(read(Format::stl, binary_stl(untidy(), header)), soup(untidy()));
}

TEST_F(MeshFileTest, StlCountThatContradictsTheLengthIsRefused) {
  const std::string four = binary_stl(tetrahedron(), "");
  const auto with_count = [&](uint32_t count, const std::string& rest = "") {
    std::string bytes = four.substr(0, 80);
    put_number(bytes, count, std::endian::little);
    return bytes + four.substr(84) + rest;
  };
  EXPECT_EQ(read(Format::stl, with_count(4)), soup(tetrahedron()));
  for (const uint32_t count : {0U, 1U, 3U})
    EXPECT_THAT(complaint(Format::stl, with_count(count)),
                HasSubstr("declares " + std::to_string(count) + " triangles, but its 284 bytes hold 4"));
  EXPECT_THAT(complaint(Format::stl, with_count(5)),
              HasSubstr("declares 5 triangles, which take 334 bytes, but has 284"));
  EXPECT_THAT(complaint(Format::stl, with_count(4, std::string(100, 'x'))), HasSubstr("hold 6"));
  // Trailing bytes that are no whole triangles are accepted: some writers append them.
  for (const size_t size : {1U, 49U, 51U, 5003U})
    EXPECT_EQ(read(Format::stl, with_count(4, std::string(size, 'x'))), soup(tetrahedron()));
}

TEST_F(MeshFileTest, TextStlDialectsAreRead) {
  const TriangleMesh expected{{{0, 0, 0}, {1, 0, 0}, {0, 1e-39F, -0.0F}}, {{0, 1, 2}}};
  for (const std::string text : {
           "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e-39 "
           "-0\nendloop\nendfacet\nendsolid\n",
           "  solid facet vertex outer\r\n\tfacet normal nan nan -nan(ind)\r\n outer loop\r\n  vertex 0 0 "
           "0\r\n  vertex 1 0 0\r\n"
           "  vertex 0 1e-39 -0\r\n endloop\r\n endfacet\r\nendsolid facet vertex\r\n",
           "SOLID X\nFACET NORMAL 0 0 1 OUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1E-39 -0\nENDLOOP "
           "ENDFACET ENDSOLID X",
       })
    EXPECT_EQ(bits(read(Format::stl, text)), bits(expected)) << text;
  const std::string solid =
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "0\nendloop\nendfacet\nendsolid a\n";
  EXPECT_EQ(read(Format::stl, solid + "\n" + solid).triangles.size(), 2U);
}

TEST_F(MeshFileTest, DamagedStlIsRefused) {
  for (const std::string text : {"solid", "solid\n", "solid a\nendsolid a\n",
                                 "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvert",
                                 "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 "
                                 "0\nendloop\nendfacet\nendsolid a\n",
                                 "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0\nvertex "
                                 "0 1 0\nendloop\nendfacet\nendsolid a\n",
                                 "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 "
                                 "0\nvertex 0 1 0\nendloop\nendfacet\n",
                                 "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 "
                                 "0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\nmore\n",
                                 "x"})
    EXPECT_NE(complaint(Format::stl, text), "") << text;
}

}  // namespace
}  // namespace papilio::client
