#include "proto/draco_reader.h"
#include "proto/draco_writer.h"
#include "tests/support/charts.h"
#include "tests/support/mesh_file_fixture.h"

// Attributes of OBJ and PLY.

namespace papilio::client {
namespace {

using proto::AttributeKind;
using proto::FormattedMesh;
using testing::ElementsAre;
using testing::IsEmpty;

class MeshFileAttributes : public MeshFileTest {
 protected:
  [[nodiscard]] FormattedMesh read_obj(const std::string& text) const {
    return read_triangles(put("in.obj", text), Format::obj);
  }
};

constexpr std::string_view kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n";

TEST_F(MeshFileAttributes, ObjCornersOfAllFormsAreRead) {
  for (const std::string face : {"f 1/1/1 2/2/1 3/3/1 4/4/1", "f -4/-4/-1 -3/-3/-1 -2/-2/-1 -1/-1/-1"}) {
    const FormattedMesh mesh = read_obj(std::string(kSquare) + face + "\n");
    EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
    ASSERT_EQ(mesh.attributes.size(), 2U);
    EXPECT_EQ(mesh.attributes[0], (Attribute{2, false, {0, 0, 1, 0, 1, 1, 0, 1}}));
    EXPECT_EQ(mesh.attributes[1], (Attribute{3, true, {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}}));
    EXPECT_EQ(mesh.format.attributes[0].kind, AttributeKind::tex_coord);
    EXPECT_EQ(mesh.format.attributes[1].kind, AttributeKind::normal);
  }
  EXPECT_EQ(read_obj(std::string(kSquare) + "f 1/1 2/2 3/3\n").attributes.size(), 1U);
  EXPECT_EQ(read_obj(std::string(kSquare) + "f 1//1 2//1 3//1\n").format.attributes[0].kind, AttributeKind::normal);
  EXPECT_THAT(read_obj(std::string(kSquare) + "f 1 2 3\n").attributes, IsEmpty());
}

TEST_F(MeshFileAttributes, ObjFacesMayPrecedeTheirVertices) {
  EXPECT_THAT(read_obj("f 1/1 2/2 3/3\n" + std::string(kSquare)).attributes[0].values,
              ElementsAre(0, 0, 1, 0, 1, 1, 0, 0));  // the fourth position has no attributes
}

TEST_F(MeshFileAttributes, SeamsAreSeveralPointsOfOnePosition) {
  const FormattedMesh mesh = read_obj(std::string(kSquare) + "f 1/1 2/2 3/3\nf 1/2 3/3 4/4\n");
  EXPECT_THAT(mesh.positions,
              ElementsAre(Vec3f{0, 0, 0}, Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{1, 1, 0}, Vec3f{0, 1, 0}));
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 2, 3}, Triangle{1, 3, 4}));
}

TEST_F(MeshFileAttributes, MissingValuesAreZero) {
  const FormattedMesh mesh = read_obj(std::string(kSquare) + "f 1/1 2 3/3\n");
  EXPECT_THAT(mesh.attributes[0].values, ElementsAre(0, 0, 0, 0, 1, 1, 0, 0));
}

TEST_F(MeshFileAttributes, TexcoordsHaveTwoComponentsUnlessTheThirdIsUsed) {
  const std::string vertices(kThree);
  EXPECT_EQ(read_obj(vertices + "vt 1\nvt 1 2\nf 1/1 2/2 3/2\n").attributes[0],
            (Attribute{2, false, {1, 0, 1, 2, 1, 2}}));
  EXPECT_EQ(read_obj(vertices + "vt 1 2 0.0\nf 1/1 2/1 3/1\n").attributes[0].components, 2U);
  EXPECT_EQ(read_obj(vertices + "vt 1 2 3\nf 1/1 2/1 3/1\n").attributes[0].components, 3U);
}

TEST_F(MeshFileAttributes, DamageIsRefused) {
  for (const std::string damage :
       {"f 1/5 2/1 3/1", "f 1/-5 2/1 3/1", "f 1/0 2/1 3/1", "f 1//2 2//1 3//1", "f 1//-2 2//1 3//1", "vt", "vt x",
        "vt 1 x", "vn 1 0", "vn", "vt 1e39 0", "f 1/99999999999999999999 2/1 3/1", "f 5/1 1/1 2/1", "f 1/1-2 2/1 3/1"})
    EXPECT_NE(complaint(Format::obj, std::string(kSquare) + damage + "\n"), "") << damage;
  EXPECT_THAT(complaint(Format::obj, std::string(kSquare) + "f 1/5 2/1 3/1\n"),
              HasSubstr("a face names a texture coordinate (vt) that is not there"));
}

TEST_F(MeshFileAttributes, ObjKeepsAttributesAndClosesSeams) {
  FormattedMesh cube = test::charted_cube();
  std::vector<double> normals;
  for (size_t p = 0; p < 24; ++p) normals.insert(normals.end(), {0.6, -0.0, 0.8});
  test::add_attribute(cube, AttributeKind::normal, proto::ValueType::float32, 3, normals);
  write_triangles(path("out.obj"), Format::obj, cube, cube.format);
  const std::string text = read_bytes(path("out.obj"), kMaxFileBytes);
  EXPECT_THAT(text, HasSubstr("# 8 vertices, 12 triangles\nv 0 0 0\n"));
  EXPECT_THAT(text, HasSubstr("\nvn 0.6 -0 0.8\nf 1/1/1 2/2/1 3/3/1\n"));
  const FormattedMesh read = read_triangles(path("out.obj"), Format::obj);
  EXPECT_EQ(read.positions.size(), 24U);
  for (size_t f = 0; f < 12; ++f)
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t p = read.triangles[f][i];
      const uint32_t q = cube.triangles[f][i];
      EXPECT_EQ(read.positions[p], cube.positions[q]);
      for (size_t k = 0; k < 2; ++k)
        EXPECT_EQ(read.attributes[0].values[2 * p + k], cube.attributes[1].values[2 * q + k]);
    }
}

TEST_F(MeshFileAttributes, NormalizedIntegersAreWrittenAsFractions) {
  FormattedMesh mesh{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, {}};
  test::add_attribute(mesh, AttributeKind::tex_coord, proto::ValueType::uint16, 2, {0, 65535, 0, 0, 65535, 0});
  test::add_attribute(mesh, AttributeKind::normal, proto::ValueType::int8, 3, {0, 0, 127, 0, 0, -127, 0, 127, 0});
  for (proto::AttributeFormat& format : mesh.format.attributes) format.normalized = true;
  write_triangles(path("out.obj"), Format::obj, mesh, mesh.format);
  EXPECT_THAT(read_bytes(path("out.obj"), kMaxFileBytes),
              HasSubstr("vt 0 1\nvt 0 0\nvt 1 0\nvn 0 0 1\nvn 0 0 -1\nvn 0 1 0\nf 1/1/1 2/2/2 3/3/3\n"));
}

TEST_F(MeshFileAttributes, PlyKeepsNormalsColoursAndTexcoords) {
  FormattedMesh cube = test::charted_cube();
  std::vector<double> colors;
  std::vector<double> normals;
  for (size_t p = 0; p < 24; ++p) {
    colors.insert(colors.end(), {10.0 * static_cast<double>(p), 0, 255, 128});
    normals.insert(normals.end(), {0, -1, 0});
  }
  test::add_attribute(cube, AttributeKind::color, proto::ValueType::uint8, 4, colors);
  cube.format.attributes.back().normalized = true;
  test::add_attribute(cube, AttributeKind::normal, proto::ValueType::float32, 3, normals);
  write_triangles(path("out.ply"), Format::ply, cube, cube.format);
  const FormattedMesh read = read_triangles(path("out.ply"), Format::ply);
  EXPECT_EQ(read.positions, cube.positions);
  EXPECT_EQ(read.triangles, cube.triangles);
  ASSERT_EQ(read.attributes.size(), 3U);  // PLY has no name for the chart's number
  EXPECT_EQ(read.attributes[0], cube.attributes[3]);
  EXPECT_EQ(read.attributes[1], cube.attributes[2]);
  EXPECT_EQ(read.attributes[2], cube.attributes[1]);
  EXPECT_EQ(read.format.attributes[1].type, proto::ValueType::uint8);
  EXPECT_TRUE(read.format.attributes[1].normalized);
}

TEST_F(MeshFileAttributes, PlyDialectsAreRead) {
  const auto read_ply = [&](const std::string& vertex, const std::string& line) {
    return read_triangles(put("in.ply", ply_header("ascii", kXyz + vertex, kIndices) + "0 0 0" + line + "1 0 0" + line +
                                            "0 1 0" + line + "3 0 1 2\n"),
                          Format::ply);
  };
  const FormattedMesh floats =
      read_ply("property float red\nproperty float green\nproperty float blue\nproperty double u\nproperty double v\n",
               " 0.5 1 0 0.25 0.75\n");
  ASSERT_EQ(floats.attributes.size(), 2U);
  EXPECT_THAT(floats.attributes[0].values, ElementsAre(0.5, 1, 0, 0.5, 1, 0, 0.5, 1, 0));
  EXPECT_EQ(floats.format.attributes[0].type, proto::ValueType::float32);
  EXPECT_THAT(floats.attributes[1].values, ElementsAre(0.25, 0.75, 0.25, 0.75, 0.25, 0.75));
  EXPECT_THAT(read_ply("property float nx\nproperty float ny\n", " 1 2\n").attributes, IsEmpty());
  EXPECT_THAT(read_ply("property list uchar float s\nproperty float t\n", " 0 2\n").attributes[0].values,
              ElementsAre(0, 2, 0, 2, 0, 2));
}

TEST_F(MeshFileAttributes, OffAndStlKeepOnlyPositions) {
  const FormattedMesh cube = test::charted_cube();
  for (const Format format : {Format::off, Format::stl}) {
    const fs::path file = path("out" + extension_of(format));
    write_triangles(file, format, cube, cube.format);
    EXPECT_THAT(read_triangles(file, format).attributes, IsEmpty());
  }
}

TEST_F(MeshFileAttributes, DamagedFilesNeverCrash) {
  const FormattedMesh cube = test::charted_cube();
  write_triangles(path("out.obj"), Format::obj, cube, cube.format);
  const std::string bytes = read_bytes(path("out.obj"), kMaxFileBytes);
  std::mt19937 random(7);
  for (int round = 0; round < 1000; ++round) {
    std::string damaged = bytes;
    for (uint32_t n = 1 + random() % 4; n > 0; --n)
      damaged[random() % damaged.size()] = "0123456789-/. \nfvtn"[random() % 19];
    try {
      const FormattedMesh mesh = read_obj(damaged);
      for (const Attribute& attribute : mesh.attributes)
        ASSERT_EQ(attribute.values.size(), mesh.positions.size() * attribute.components);
    } catch (const FileError& error) {
      EXPECT_THAT(error.what(), HasSubstr("in.obj"));
    }
  }
}

/// Returns the group of each face; empty without groups.
std::vector<double> groups_of(const proto::FormattedMesh& mesh) {
  std::vector<double> groups;
  for (size_t a = 0; a < mesh.attributes.size(); ++a) {
    if (!mesh.attributes[a].is_smoothing_group) continue;
    EXPECT_EQ(mesh.format.attributes[a].name, "smoothing_group");
    EXPECT_EQ(mesh.format.attributes[a].kind, proto::AttributeKind::generic);
    for (const Triangle& t : mesh.triangles) {
      groups.push_back(mesh.attributes[a].values[t[0]]);
      for (const uint32_t p : t) EXPECT_EQ(mesh.attributes[a].values[p], groups.back());
    }
  }
  return groups;
}

TEST_F(MeshFileAttributes, ObjSmoothingGroupsAreRead) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const std::string faces[]{"f 1 3 2\n", "f 1 2 4\n", "f 2 3 4\n", "f 3 1 4\n"};
  const auto groups = [&](const std::string& text) {
    return groups_of(parse_triangles("it", Format::obj, vertices + text));
  };
  using Groups = std::vector<double>;
  EXPECT_EQ(groups(faces[0] + "s 1\n" + faces[1] + "s off\n" + faces[2] + "s 1\n" + faces[3]), (Groups{1, 2, 0, 2}));
  EXPECT_EQ(groups("s 4294967295\n" + faces[0] + "s 8\n" + faces[1] + "s 0\n" + faces[2] + "s nonsense\n" + faces[3]),
            (Groups{2, 3, 0, 0}));
  for (const char* all : {"", "s 1\n", "s off\n", "s 0\n"})
    EXPECT_EQ(groups(all + faces[0] + faces[1] + all + faces[2] + faces[3]), Groups{}) << all;
}

TEST_F(MeshFileAttributes, SmoothingGroupsRoundTripThroughObjAndDraco) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ns 1\nf 1 3 2\nf 1 2 4\ns off\nf 2 3 4\ns 2\nf 3 1 4\n";
  const proto::FormattedMesh mesh = parse_triangles("it", Format::obj, text);
  const std::string written = encode_triangles("it", Format::obj, mesh, mesh.format);
  EXPECT_THAT(written, HasSubstr("# 4 vertices"));
  EXPECT_EQ(groups_of(parse_triangles("it", Format::obj, written)), groups_of(mesh));
  const proto::FormattedMesh read = proto::read_draco(proto::write_draco_exact(mesh, mesh.format), {});
  std::vector<double> sorted = groups_of(read), expected = groups_of(mesh);  // the encoder orders faces
  std::ranges::sort(sorted);
  std::ranges::sort(expected);
  EXPECT_EQ(sorted, expected);
}

}  // namespace
}  // namespace papilio::client
