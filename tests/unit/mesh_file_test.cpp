#include <sys/resource.h>

#include <csignal>
#include <cstring>

#include "tests/support/mesh_file_fixture.h"

// Files as a whole: names, round trips, damage of any kind, writing.

namespace papilio::client {
namespace {

using testing::ElementsAre;

TEST_F(MeshFileTest, ExtensionDeterminesTheFormat) {
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
    EXPECT_STREQ(
        error.what(),
        "some/mesh.Fbx: '.Fbx' is not a known extension; use one of .drc, .obj, .ply, .off, .stl, .glb, .gltf");
  }
}

TEST_F(MeshFileTest, DracoIsALogicError) {
  EXPECT_THROW((void)read_triangles(path("a.drc"), Format::drc), std::logic_error);
  EXPECT_THROW(write_triangles(path("a.drc"), Format::drc, tetrahedron()), std::logic_error);
  EXPECT_EQ(files(), 0U);
}

TEST_F(MeshFileTest, RoundTripsAreBitIdentical) {
  for (const TriangleMesh& mesh : {tetrahedron(), untidy(), hard_numbers()}) {
    for (const Format format : kFormats) {
      const TriangleMesh expected = format == Format::stl ? soup(mesh) : mesh;
      const TriangleMesh found = round_trip(format, mesh);
      EXPECT_EQ(bits(found), bits(expected)) << extension_of(format);
      EXPECT_EQ(found.triangles, expected.triangles) << extension_of(format);
    }
  }
}

TEST_F(MeshFileTest, RoundTripsOfRealMeshesAreBitIdentical) {
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

/// Valid files of every format, small enough to be damaged at every byte.
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

/// Returns whether the file is read. The mesh must then be valid.
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

TEST_F(MeshFileTest, TruncatedFilesAreRefused) {
  for (const auto& [format, bytes] : sound_files()) {
    EXPECT_TRUE(is_taken(put("whole", bytes), format)) << bytes;
    for (size_t size = 0; size < bytes.size(); ++size) {
      const std::string cut = bytes.substr(0, size);
      const bool taken = is_taken(put("cut", cut), format);
      // OBJ has no end marker, and the last words of a text may belong to a colour, a name or a line.
      const size_t can_end =
          format == Format::obj ? bytes.find("f 1//1") : bytes.size() - (format == Format::off ? 13 : 4);
      if (size < can_end) {
        EXPECT_FALSE(taken) << cut;
      }
    }
  }
}

TEST_F(MeshFileTest, DamagedFilesAreRefusedOrValid) {
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

TEST_F(MeshFileTest, RandomBytesAreRefused) {
  std::mt19937 random(5);
  for (int round = 0; round < 50; ++round) {
    std::string garbage(random() % 2000, ' ');
    for (char& c : garbage) c = static_cast<char>(random());
    for (const Format format : kFormats) EXPECT_FALSE(is_taken(put("garbage", garbage), format));
  }
}

TEST_F(MeshFileTest, MissingAndEmptyFilesAreRefused) {
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

TEST_F(MeshFileTest, BytesAboveTheLimitAreRefused) {
  const std::string bytes(200'000, 'x');
  EXPECT_EQ(read_bytes(put("bytes", bytes), bytes.size()), bytes);
  EXPECT_THROW((void)read_bytes(path("bytes"), bytes.size() - 1), FileError);
  EXPECT_THROW((void)read_bytes("/dev/zero", 1 << 20), FileError);
  EXPECT_EQ(read_bytes(put("empty", ""), 0), "");
}

TEST_F(MeshFileTest, WritingReplacesTheWholeFile) {
  write_atomically(path("a"), "a longer content");
  write_atomically(path("a"), std::string_view("b\0c", 3));
  EXPECT_EQ(read_bytes(path("a"), 100), std::string("b\0c", 3));
  EXPECT_EQ(files(), 1U);
  write_atomically(path(std::string(255, 'n')), "the longest name");
  EXPECT_EQ(files(), 2U);
}

TEST_F(MeshFileTest, WritingFollowsSymlinks) {
  put("target", "old");
  fs::create_symlink("target", path("link"));
  write_atomically(path("link"), "new");
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(read_bytes(path("target"), 100), "new");
}

TEST_F(MeshFileTest, FailedWriteLeavesNoFile) {
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

TEST_F(MeshFileTest, WriteWithoutPermissionLeavesNoFile) {
  EXPECT_THROW(write_atomically("/proc/papilio", "x"), FileError);  // not even root may write there
  EXPECT_FALSE(fs::exists("/proc/papilio"));
}

TEST_F(MeshFileTest, FullDiskKeepsTheOldFile) {
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

TEST_F(MeshFileTest, MeshWithInvalidIndicesIsNotWritten) {
  TriangleMesh mesh = tetrahedron();
  mesh.triangles[2][1] = 4;
  for (const Format format : kFormats)
    EXPECT_THROW(write_triangles(path("bad" + extension_of(format)), format, mesh), std::invalid_argument);
  EXPECT_EQ(files(), 0U);
}

TEST_F(MeshFileTest, ObjFacesOfTwoCornersAreDropped) {
  const std::string lines = std::string(kThree) + "vt 0 0\nf 1/1 2/1\nf 2\nf 1 2 3\n";
  const proto::FormattedMesh mesh = read_triangles(put("lines.obj", lines), Format::obj);
  EXPECT_EQ(mesh.triangles, (Buffer<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(mesh.positions.size(), 3U);
  EXPECT_TRUE(mesh.attributes.empty());
  EXPECT_THAT(complaint(Format::obj, std::string(kThree) + "f 1 2 3\nf 1 2"), HasSubstr("cut short"));
}

TEST_F(MeshFileTest, StlNormalsOfDegenerateFacesAreZero) {
  const std::string bytes = written(Format::stl, {{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}, {{0, 1, 2}, {0, 1, 1}}});
  float normals[2][3];
  std::memcpy(normals[0], bytes.data() + 84, 12);
  std::memcpy(normals[1], bytes.data() + 134, 12);
  EXPECT_THAT(normals[0], ElementsAre(0, 0, 1));
  EXPECT_THAT(normals[1], ElementsAre(0, 0, 0));
}

}  // namespace
}  // namespace papilio::client
