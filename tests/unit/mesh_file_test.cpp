#include "client/mesh_file/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>
#include <string>

// Under the sanitizers g++ takes the points that OpenMesh fills in later for forgotten ones.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

namespace papilio::client {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<Format> kFormats{Format::obj, Format::ply, Format::off, Format::stl};

std::string extension_of(Format format) {
  switch (format) {
    case Format::obj:
      return ".obj";
    case Format::ply:
      return ".ply";
    case Format::off:
      return ".off";
    case Format::stl:
      return ".stl";
    case Format::drc:
      break;
  }
  return ".drc";
}

/// A folder of its own for each test.
class mesh_file : public testing::Test {
 protected:
  mesh_file() {
    std::string pattern = (fs::temp_directory_path() / "papilio-mesh-file-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~mesh_file() override { fs::remove_all(folder_); }

  [[nodiscard]] fs::path path(const std::string& name) const { return folder_ / name; }

  fs::path put(const std::string& name, std::string_view bytes) const {
    fs::remove(path(name));  // some file systems flush when a file is emptied and written anew
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }

  [[nodiscard]] TriangleMesh read(Format format, std::string_view bytes) const {
    return read_triangles(put("in" + extension_of(format), bytes), format);
  }

  /// What reading says against these bytes; empty if it takes them.
  [[nodiscard]] std::string complaint(Format format, std::string_view bytes) const {
    try {
      (void)read(format, bytes);
      return "";
    } catch (const FileError& error) {
      EXPECT_THAT(error.what(), HasSubstr("in" + extension_of(format)));
      return error.what();
    }
  }

  [[nodiscard]] std::string written(Format format, const TriangleMesh& mesh) const {
    write_triangles(path("out" + extension_of(format)), format, mesh);
    return read_bytes(path("out" + extension_of(format)), kMaxFileBytes);
  }

  [[nodiscard]] TriangleMesh round_trip(Format format, const TriangleMesh& mesh) const {
    write_triangles(path("trip" + extension_of(format)), format, mesh);
    return read_triangles(path("trip" + extension_of(format)), format);
  }

  [[nodiscard]] size_t files() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

 private:
  fs::path folder_;
};

TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

/// Everything that OpenMesh would refuse: repeated, degenerate and non-manifold faces, an unused vertex.
TriangleMesh untidy() {
  TriangleMesh mesh = tetrahedron();
  mesh.positions.push_back({7, 7, 7});
  mesh.positions.push_back(mesh.positions[0]);
  mesh.triangles.insert(mesh.triangles.end(), {{0, 2, 1}, {1, 2, 0}, {0, 0, 1}, {3, 3, 3}, {0, 1, 5}, {5, 1, 2}});
  return mesh;
}

/// Floats of every size, zeros of both signs, the smallest and the largest.
TriangleMesh hard_numbers() {
  using Limits = std::numeric_limits<float>;
  TriangleMesh mesh{{{0.1F, -0.0F, 1.0F / 3},
                     {Limits::min(), Limits::denorm_min(), -Limits::denorm_min()},
                     {Limits::max(), Limits::lowest(), Limits::epsilon()}},
                    {{0, 1, 2}}};
  std::mt19937 random(11);
  const auto any_float = [&random] {
    for (;;)
      if (const auto value = std::bit_cast<float>(static_cast<uint32_t>(random())); std::isfinite(value)) return value;
  };
  for (uint32_t i = 3; i < 3000; ++i) {
    const float x = any_float(), y = any_float(), z = any_float();
    mesh.positions.push_back({x, y, z});
    mesh.triangles.push_back({i, i - 1, i - 3});
  }
  return mesh;
}

std::vector<uint32_t> bits(const TriangleMesh& mesh) {
  std::vector<uint32_t> all;
  for (const Vec3f& p : mesh.positions)
    for (const float coordinate : {p.x, p.y, p.z}) all.push_back(std::bit_cast<uint32_t>(coordinate));
  return all;
}

/// Three positions of its own for each triangle, as STL has it.
TriangleMesh soup(const TriangleMesh& mesh) {
  TriangleMesh apart;
  for (const Triangle& triangle : mesh.triangles) {
    const auto first = static_cast<uint32_t>(apart.positions.size());
    for (const uint32_t vertex : triangle) apart.positions.push_back(mesh.positions[vertex]);
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  return apart;
}

std::vector<fs::path> real_meshes() {
  std::vector<fs::path> found;
  const char* folder = std::getenv("PAPILIO_MESHES");
  if (folder == nullptr || !fs::is_directory(fs::path(folder) / "cgal")) return found;
  for (const auto& entry : fs::directory_iterator(fs::path(folder) / "cgal"))
    if (entry.path().extension() == ".off") found.push_back(entry.path());
  return found;
}

TEST_F(mesh_file, format_is_told_by_extension) {
  EXPECT_EQ(format_of("a/b.drc"), Format::drc);
  EXPECT_EQ(format_of("b.OBJ"), Format::obj);
  EXPECT_EQ(format_of("b.x.Ply"), Format::ply);
  EXPECT_EQ(format_of("b.off"), Format::off);
  EXPECT_EQ(format_of("b.STL"), Format::stl);
  EXPECT_THROW((void)format_of("b"), FileError);
  EXPECT_THROW((void)format_of(".obj"), FileError);
  try {
    (void)format_of("some/mesh.Fbx");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_STREQ(error.what(),
                 "some/mesh.Fbx: '.Fbx' is not a known extension; use one of .drc, .obj, .ply, .off, .stl");
  }
}

TEST_F(mesh_file, draco_belongs_to_proto) {
  EXPECT_THROW((void)read_triangles(path("a.drc"), Format::drc), std::logic_error);
  EXPECT_THROW(write_triangles(path("a.drc"), Format::drc, tetrahedron()), std::logic_error);
  EXPECT_EQ(files(), 0U);
}

TEST_F(mesh_file, round_trips_keep_every_bit) {
  for (const TriangleMesh& mesh : {tetrahedron(), untidy(), hard_numbers()}) {
    for (const Format format : kFormats) {
      const TriangleMesh expected = format == Format::stl ? soup(mesh) : mesh;
      const TriangleMesh found = round_trip(format, mesh);
      EXPECT_EQ(bits(found), bits(expected)) << extension_of(format);
      EXPECT_EQ(found.triangles, expected.triangles) << extension_of(format);
    }
  }
}

TEST_F(mesh_file, round_trips_of_real_meshes_keep_every_bit) {
  const std::vector<fs::path> meshes = real_meshes();
  ASSERT_FALSE(meshes.empty()) << "PAPILIO_MESHES names no folder with cgal/*.off; run ./dev test";
  for (const fs::path& source : meshes) {
    if (source.filename() == "prim.off") {  // declares seven faces and has eight
      EXPECT_THAT([&] { (void)read_triangles(source, Format::off); },
                  testing::ThrowsMessage<FileError>(HasSubstr("goes on after the faces that it declares")));
      continue;
    }
    const TriangleMesh mesh = read_triangles(source, Format::off);
    for (const Format format : kFormats) {
      const TriangleMesh expected = format == Format::stl ? soup(mesh) : mesh;
      const TriangleMesh found = round_trip(format, mesh);
      EXPECT_EQ(bits(found), bits(expected)) << source << extension_of(format);
      EXPECT_EQ(found.triangles, expected.triangles) << source << extension_of(format);
    }
  }
}

using OpenMeshTriangles = OpenMesh::TriMesh_ArrayKernelT<>;

TriangleMesh from_openmesh(const OpenMeshTriangles& mesh) {
  TriangleMesh result;
  for (const auto vertex : mesh.vertices()) {
    const auto p = mesh.point(vertex);
    result.positions.push_back({p[0], p[1], p[2]});
  }
  for (const auto face : mesh.faces()) {
    Triangle triangle{};
    size_t corner = 0;
    for (const auto vertex : mesh.fv_range(face)) triangle[corner++] = static_cast<uint32_t>(vertex.idx());
    // Its faces may begin at any corner.
    std::ranges::rotate(triangle, std::ranges::min_element(triangle));
    result.triangles.push_back(triangle);
  }
  return result;
}

TriangleMesh with_smallest_first(TriangleMesh mesh) {
  for (Triangle& triangle : mesh.triangles) std::ranges::rotate(triangle, std::ranges::min_element(triangle));
  return mesh;
}

/// The triangles of a soup, by the number of each corner's position in `positions`.
TriangleMesh welded(const TriangleMesh& apart, const std::vector<Vec3f>& positions) {
  TriangleMesh mesh{positions, apart.triangles};
  for (Triangle& triangle : mesh.triangles)
    for (uint32_t& vertex : triangle)
      vertex = static_cast<uint32_t>(std::ranges::find(positions, apart.positions[vertex]) - positions.begin());
  return mesh;
}

TEST_F(mesh_file, openmesh_reads_what_is_written) {
  for (const Format format : {Format::obj, Format::ply, Format::off}) {
    const fs::path file = path("ours" + extension_of(format));
    write_triangles(file, format, tetrahedron());
    OpenMeshTriangles mesh;
    ASSERT_TRUE(OpenMesh::IO::read_mesh(mesh, file.string()));
    EXPECT_EQ(from_openmesh(mesh), with_smallest_first(tetrahedron())) << file;
  }
  write_triangles(path("ours.stl"), Format::stl, tetrahedron());
  OpenMeshTriangles welded;
  ASSERT_TRUE(OpenMesh::IO::read_mesh(welded, path("ours.stl").string()));
  EXPECT_EQ(welded.n_vertices(), 4U);
  EXPECT_EQ(welded.n_faces(), 4U);
}

TEST_F(mesh_file, reads_what_openmesh_writes) {
  const TriangleMesh mesh = tetrahedron();
  OpenMeshTriangles theirs;
  for (const Vec3f& p : mesh.positions) theirs.add_vertex({p.x, p.y, p.z});
  for (const auto& [a, b, c] : mesh.triangles)
    theirs.add_face(theirs.vertex_handle(a), theirs.vertex_handle(b), theirs.vertex_handle(c));
  theirs.request_vertex_normals();
  theirs.request_face_normals();  // update_normals needs them
  theirs.update_normals();
  using Options = OpenMesh::IO::Options;
  const std::vector<std::pair<Format, OpenMesh::IO::Options>> kinds{
      {Format::obj, Options::Default},
      {Format::obj, Options::VertexNormal},
      {Format::off, Options::Default},
      {Format::off, Options::VertexNormal},
      {Format::ply, Options::Default},
      {Format::ply, Options::VertexNormal},
      {Format::ply, Options::Binary},
      {Format::ply, Options::Binary | Options::VertexNormal},
      {Format::ply, Options::Binary | Options::MSB},
      {Format::stl, Options::Default},
      {Format::stl, Options::Binary},
  };
  for (const auto& [format, options] : kinds) {
    const fs::path file = path("theirs" + extension_of(format));
    ASSERT_TRUE(OpenMesh::IO::write_mesh(theirs, file.string(), options));
    const TriangleMesh found = read_triangles(file, format);
    EXPECT_EQ(with_smallest_first(format == Format::stl ? welded(found, mesh.positions) : found),
              with_smallest_first(mesh))
        << extension_of(format) << " with options " << static_cast<unsigned>(options);
  }
}

constexpr std::string_view kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST_F(mesh_file, obj_corners_in_all_their_forms) {
  const std::string vertices(kThree);
  for (const std::string face : {"f 1 2 3", "f 1/4 2/5 3/6", "f 1//4 2//5 3//6", "f 1/4/7 2/5/8 3/6/9", "f -3 -2 -1",
                                 "f -3/-1/-2 -2//-1 -1/-1", "f\t1  2 \\\n3", "f 1 2 \\\r\n 3 # three", "f +1 2/ 3//"})
    EXPECT_THAT(read(Format::obj, vertices + face).triangles, ElementsAre(Triangle{0, 1, 2})) << face;
}

TEST_F(mesh_file, obj_negative_corners_count_from_the_latest_vertex) {
  const std::string text = std::string(kThree) + "f -3 -2 -1\nv 1 1 0\nf -3 -1 -2\n";
  EXPECT_THAT(read(Format::obj, text).triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{1, 3, 2}));
}

TEST_F(mesh_file, obj_faces_may_come_first) {
  EXPECT_THAT(read(Format::obj, "f 1 2 3\n" + std::string(kThree)).triangles, ElementsAre(Triangle{0, 1, 2}));
}

TEST_F(mesh_file, obj_other_keywords_are_passed_over) {
  const std::string text =
      "# made by hand\r\n\r\nmtllib /dev/zero\r\no thing\r\ng a b\r\nv 0 0 0 1.0\r\nv 1 0 0 0.5 0.5 0.5\r\nv "
      "0 1 0\r\n"
      "vt 0 0\r\nvn 0 0 1\r\nusemtl none\r\ns off\r\nl 1 2\r\nf 1 2 3\r\n";
  EXPECT_EQ(read(Format::obj, text), (TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}));
}

TEST_F(mesh_file, polygons_become_fans) {
  const std::string pentagon = "0 0 0\n2 0 0\n3 1 0\n1 2 0\n0 1 0\n";
  const auto fan = ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 3, 4});
  EXPECT_THAT(read(Format::obj, "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 2 0\nv 0 1 0\nf 1 2 3 4 5\n").triangles, fan);
  EXPECT_THAT(read(Format::off, "OFF\n5 1 0\n" + pentagon + "5 0 1 2 3 4\n").triangles, fan);
  EXPECT_THAT(read(Format::ply,
                   "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
                   "element face 1\nproperty list uchar int vertex_index\nend_header\n" +
                       pentagon + "5 0 1 2 3 4\n")
                  .triangles,
              fan);
}

TEST_F(mesh_file, a_number_is_read_as_the_nearest_float) {
  const TriangleMesh mesh =
      read(Format::obj, "v 0.1 1e-60 -1e-400\nv 16777217.000001 +.5 1e-45\nv nan inf -inf\nf 1 2 3\n");
  EXPECT_EQ(mesh.positions[0], (Vec3f{0.1F, 0, 0}));
  EXPECT_EQ(mesh.positions[1], (Vec3f{16777218, 0.5F, std::numeric_limits<float>::denorm_min()}));
  EXPECT_TRUE(std::isnan(mesh.positions[2].x));
  EXPECT_THAT(complaint(Format::obj, "v 0 0 0\nv 1e39 0 0\nv 0 1 0\nf 1 2 3\n"),
              HasSubstr("line 2: expected a number"));
}

TEST_F(mesh_file, obj_damage_is_refused) {
  const std::string vertices(kThree);
  for (const std::string damage :
       {"f 1 2 4", "f 0 1 2", "f -4 1 2", "f 1 2", "f 1 2 x3", "f 1.5 2 3", "f /1/2 2 3", "f 1 2 99999999999999999999",
        "f 1 2 4294967297", "f 1,2,3", "v 1 2", "v 1 2 x", "v", "f", "f 1 2 3/x", "", "f 1 2 3\nv 1e39 0 0"})
    EXPECT_NE(complaint(Format::obj, vertices + damage + "\n"), "") << damage;
  EXPECT_NE(complaint(Format::obj, std::string("v 0 0 0\0f 1 1 1\n", 16)), "");
  EXPECT_THAT(complaint(Format::obj, vertices + "\nf 1 2 bad\n"),
              HasSubstr("line 5: expected the number of a vertex, found 'bad'; export the mesh again"));
}

constexpr std::string_view kOffBody = "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

TEST_F(mesh_file, off_in_its_dialects) {
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

TEST_F(mesh_file, off_damage_is_refused) {
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

TEST_F(mesh_file, off_goes_on_after_its_faces) {
  EXPECT_THAT(complaint(Format::off, "OFF\n" + std::string(kOffBody) + "3 2 1 0\n"),
              HasSubstr("line 7: the file goes on"));
}

std::string ply_header(const std::string& format, const std::string& vertex, const std::string& face) {
  return "ply\nformat " + format + " 1.0\ncomment element face 7\nobj_info end_header\nelement vertex 3\n" + vertex +
         "element face 1\n" + face + "end_header\n";
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kIndices = "property list uchar int vertex_indices\n";
const std::string kPlyText = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

template <class Number>
void put_number(std::string& bytes, Number number, std::endian order) {
  auto raw = std::bit_cast<std::array<char, sizeof number>>(number);
  if (order != std::endian::native) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

TEST_F(mesh_file, ply_skips_what_it_does_not_know) {
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

TEST_F(mesh_file, ply_damage_is_refused) {
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

TEST_F(mesh_file, ply_may_declare_what_it_likes) {
  for (const std::string format : {"ascii", "binary_little_endian"}) {
    for (const std::string element : {"vertex", "face", "thing"}) {
      const std::string text = "ply\nformat " + format + " 1.0\nelement " + element + " 4000000000\n" +
                               (element == "face" ? kIndices : kXyz) + "end_header\n0 0 0\n";
      EXPECT_THAT(complaint(Format::ply, text), HasSubstr("4000000000 elements")) << text;
    }
  }
}

std::string binary_stl(const TriangleMesh& mesh, const std::string& header) {
  std::string bytes = header;
  bytes.resize(80);
  put_number(bytes, static_cast<uint32_t>(mesh.triangles.size()), std::endian::little);
  for (const Triangle& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) put_number(bytes, 0.0F, std::endian::little);
    for (const uint32_t vertex : triangle) {
      const Vec3f p = mesh.positions[vertex];
      for (const float coordinate : {p.x, p.y, p.z}) put_number(bytes, coordinate, std::endian::little);
    }
    bytes += "\x7f\xff";
  }
  return bytes;
}

TEST_F(mesh_file, stl_binary_may_begin_with_solid) {
  for (const std::string header : {"", "solid", "solid facet normal 0 0 1"}) {
    const std::string bytes = binary_stl(untidy(), header);
    EXPECT_EQ(bits(read(Format::stl, bytes)), bits(soup(untidy())));
    EXPECT_EQ(read(Format::stl, bytes + "x"), soup(untidy())) << "bytes after the triangles";
    EXPECT_THAT(complaint(Format::stl, bytes.substr(0, bytes.size() - 1)), HasSubstr("cut short"));
  }
}

TEST_F(mesh_file, stl_text_in_its_dialects) {
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

TEST_F(mesh_file, stl_damage_is_refused) {
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

/// Sound files of every format, small enough to be damaged in every place.
std::vector<std::pair<Format, std::string>> sound_files() {
  return {
      {Format::obj, "# tetrahedron\n" + std::string(kThree) + "vn 0 0 1\nf 1//1 2//1 3//1\nf -3 -2 -1\n"},
      {Format::off, "OFF\n" + std::string(kOffBody)},
      {Format::off, "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 255 0 255\n0 1 0 0 0 255 255\n3 0 1 2 0.5 0.5 0.5\n"},
      {Format::ply, ply_header("ascii", kXyz, kIndices) + kPlyText},
      {Format::ply,
       ply_header("ascii", kXyz, kIndices + "property list uint8 float uv\n") + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 1 0\n"},
      {Format::ply,
       ply_header("binary_little_endian", kXyz, kIndices) + std::string(36, '\0') + "\3" + std::string(12, '\0')},
      {Format::ply,
       ply_header("binary_big_endian", kXyz, kIndices) + std::string(36, '\0') + "\3" + std::string(12, '\0')},
      {Format::stl, binary_stl(tetrahedron(), "solid")},
      {Format::stl,
       "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
       "0\nendloop\nendfacet\nendsolid a\n"},
  };
}

/// Whether it is taken; if so, it must make sense.
bool is_taken(const fs::path& file, Format format) {
  try {
    const TriangleMesh mesh = read_triangles(file, format);
    EXPECT_FALSE(mesh.triangles.empty());
    for (const Triangle& triangle : mesh.triangles)
      for (const uint32_t vertex : triangle) EXPECT_LT(vertex, mesh.positions.size());
    return true;
  } catch (const FileError&) {
    return false;
  }
}

TEST_F(mesh_file, files_cut_short_are_refused) {
  for (const auto& [format, bytes] : sound_files()) {
    EXPECT_TRUE(is_taken(put("whole", bytes), format)) << bytes;
    for (size_t size = 0; size < bytes.size(); ++size) {
      const std::string cut = bytes.substr(0, size);
      const bool taken = is_taken(put("cut", cut), format);
      // What tells OBJ's end is nothing, and a text's last words may be the end of a colour, of a name or of
      // a line.
      const size_t can_end =
          format == Format::obj ? bytes.find("f 1//1") : bytes.size() - (format == Format::off ? 13 : 4);
      if (size < can_end) {
        EXPECT_FALSE(taken) << cut;
      }
    }
  }
}

TEST_F(mesh_file, damaged_files_are_refused_or_make_sense) {
  std::mt19937 random(3);
  const std::vector<std::string> scraps{"\n",  " ",     "-",          "/",           "\\\n", "#",
                                        "nan", "1e999", "4294967295", "-2147483649", "\xff"};
  size_t refused = 0;
  for (const auto& [format, bytes] : sound_files()) {
    for (int round = 0; round < 200; ++round) {
      std::string damaged = bytes;
      for (auto changes = 1 + random() % 3; changes > 0; --changes) {
        const size_t place = random() % damaged.size();
        switch (random() % 4) {
          case 0:
            damaged[place] = static_cast<char>(random());
            break;
          case 1:
            damaged.erase(place, 1 + random() % 8);
            break;
          case 2:
            damaged.insert(place, scraps[random() % scraps.size()]);
            break;
          default:
            damaged[place] = static_cast<char>(damaged[place] ^ (1 << random() % 8));
        }
        if (damaged.empty()) damaged = "x";
      }
      refused += is_taken(put("damaged", damaged), format) ? 0 : 1;
    }
  }
  EXPECT_GT(refused, 500U);
}

TEST_F(mesh_file, garbage_is_refused) {
  std::mt19937 random(5);
  for (int round = 0; round < 50; ++round) {
    std::string garbage(random() % 2000, ' ');
    for (char& c : garbage) c = static_cast<char>(random());
    for (const Format format : kFormats) EXPECT_FALSE(is_taken(put("garbage", garbage), format));
  }
}

TEST_F(mesh_file, what_is_no_file_is_refused) {
  for (const Format format : kFormats) {
    EXPECT_THROW((void)read_triangles(path("absent"), format), FileError);
    EXPECT_THROW((void)read_triangles(path(""), format), FileError);
    EXPECT_THAT(complaint(format, ""), HasSubstr("is empty"));
  }
  try {
    (void)read_triangles(path("absent.obj"), Format::obj);
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("absent.obj: cannot be opened: No such file or directory; check the name"));
  }
}

TEST_F(mesh_file, bytes_are_read_up_to_a_limit) {
  const std::string bytes(200'000, 'x');
  EXPECT_EQ(read_bytes(put("bytes", bytes), bytes.size()), bytes);
  EXPECT_THROW((void)read_bytes(path("bytes"), bytes.size() - 1), FileError);
  EXPECT_THROW((void)read_bytes("/dev/zero", 1 << 20), FileError);
  EXPECT_EQ(read_bytes(put("empty", ""), 0), "");
}

TEST_F(mesh_file, writing_replaces_the_whole_file) {
  write_atomically(path("a"), "a longer content");
  write_atomically(path("a"), std::string_view("b\0c", 3));
  EXPECT_EQ(read_bytes(path("a"), 100), std::string("b\0c", 3));
  EXPECT_EQ(files(), 1U);
  write_atomically(path(std::string(255, 'n')), "the longest name");
  EXPECT_EQ(files(), 2U);
}

TEST_F(mesh_file, writing_follows_links) {
  put("target", "old");
  fs::create_symlink("target", path("link"));
  write_atomically(path("link"), "new");
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(read_bytes(path("target"), 100), "new");
}

TEST_F(mesh_file, failed_writing_leaves_nothing) {
  fs::create_directory(path("folder"));
  put("file", "kept");
  EXPECT_THROW(write_atomically(path("absent/a"), "x"), FileError);
  EXPECT_THROW(write_atomically(path("file/a"), "x"), FileError);
  EXPECT_THROW(write_atomically(path("folder"), "x"), FileError);
  EXPECT_THROW(write_atomically(path(std::string(256, 'n')), "x"), FileError);
  EXPECT_THROW(write_atomically("/dev/null", "x"), FileError);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(files(), 2U);
  try {
    write_atomically(path("absent/a"), "x");
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("absent/a: cannot be written: No such file or directory; check the name"));
  }
}

TEST_F(mesh_file, writing_without_permission_leaves_nothing) {
  EXPECT_THROW(write_atomically("/proc/papilio", "x"), FileError);  // not even root may write there
  EXPECT_FALSE(fs::exists("/proc/papilio"));
}

TEST_F(mesh_file, a_full_disk_keeps_the_old_file) {
  put("mesh.ply", "old");
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{.rlim_cur = 1000, .rlim_max = before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  std::string complaint;
  try {
    write_triangles(path("mesh.ply"), Format::ply, hard_numbers());
  } catch (const FileError& error) {
    complaint = error.what();
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(complaint, HasSubstr("mesh.ply: cannot be written: File too large"));
  EXPECT_EQ(read_bytes(path("mesh.ply"), 100), "old");
  EXPECT_EQ(files(), 1U);
}

TEST_F(mesh_file, a_mesh_with_bad_indices_is_not_written) {
  TriangleMesh mesh = tetrahedron();
  mesh.triangles[2][1] = 4;
  for (const Format format : kFormats)
    EXPECT_THROW(write_triangles(path("bad" + extension_of(format)), format, mesh), std::invalid_argument);
  EXPECT_EQ(files(), 0U);
}

TEST_F(mesh_file, stl_normals_are_zero_where_there_is_none) {
  const std::string bytes = written(Format::stl, {{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}, {{0, 1, 2}, {0, 1, 1}}});
  float normals[2][3];
  std::memcpy(normals[0], bytes.data() + 84, 12);
  std::memcpy(normals[1], bytes.data() + 134, 12);
  EXPECT_THAT(normals[0], ElementsAre(0, 0, 1));
  EXPECT_THAT(normals[1], ElementsAre(0, 0, 0));
}

}  // namespace
}  // namespace papilio::client
