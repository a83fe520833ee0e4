#include "proto/edgebreaker/writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <tuple>
#include <utility>

#include "client/mesh_file/mesh_file.h"
#include "core/refine.h"
#include "proto/draco_reader.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"
#include "tests/support/small_surfaces.h"

// Written from the half-edges, to the byte as libdraco writes it.

namespace papilio::proto {
namespace {

using namespace test;

/// False where libdraco has to write it.
bool is_the_same(const Mesh& mesh, const OutputOptions& options) {
  const QuantizationBox box = quantization_box(mesh.positions);
  const std::optional<std::string> own = edgebreaker::write(mesh, box, options, 0);
  if (!own) return false;
  EXPECT_TRUE(*own == write_with_libdraco(mesh, box, options))
      << mesh.topology.face_count() << " faces, speed " << options.speed << ", bits " << options.position_bits;
  return true;
}

TEST(Edgebreaker, IsLibdracosOnShapes) {
  for (const TriangleMesh& shape :
       {tetrahedron(), icosahedron(), cube(), torus(3, 3), torus(7, 5), grid(1, 1), grid(4, 3), fan(1, false),
        fan(5, true), fan(40, false), bipyramid(3), bipyramid(50), square_ring(4, 1, 2, 0.5F),
        join(torus(5, 4), grid(2, 2), 5), box({9, 7, 8}, {3, 2, 1})})
    for (int speed = 2; speed <= 10; ++speed)
      for (int bits = 8; bits <= 16; ++bits)
        EXPECT_TRUE(is_the_same(build_mesh(shape), {.position_bits = bits, .speed = speed}));
}

TEST(Edgebreaker, IsLibdracosOnRandomManifolds) {
  std::mt19937 random(5);
  int own = 0;
  for (int i = 0; i < 4000; ++i) {
    const OutputOptions options{.position_bits = 8 + i % 9, .speed = 2 + i % 6};
    own += is_the_same(build_mesh(random_manifold(random)), options) ? 1 : 0;
  }
  EXPECT_GT(own, 3000);
}

TEST(Edgebreaker, IsLibdracosOnRefinedRealMeshes) {
  for (const char* name : {"bunny600.obj", "elephant2000.obj"}) {
    const Mesh coarse = build_mesh(real_mesh(name));
    for (int levels = 0; levels <= 3; ++levels)
      for (int speed : {3, 7}) {
        EXPECT_TRUE(is_the_same(refine(coarse, {.levels = levels}).mesh, {.position_bits = 11, .speed = speed}));
        const Options adaptive{.levels = levels, .tolerance = 1e-4, .edges = false};
        EXPECT_TRUE(is_the_same(refine(coarse, adaptive).mesh, {.position_bits = 14, .speed = speed}));
      }
  }
}

// Under sanitizers, which take ten times as long, only what is not too large.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr uint32_t most_faces = 30'000;
#else
constexpr uint32_t most_faces = 10'000'000;
#endif

class EdgebreakerAtSpeed : public testing::TestWithParam<int> {};

TEST_P(EdgebreakerAtSpeed, IsLibdracosOnAllRealMeshesInAllLevels) {
  int own = 0;
  int left = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(std::getenv("PAPILIO_MESHES")) / "cgal")) {
    Mesh mesh;
    try {
      mesh = build_mesh(client::read_triangles(entry.path(), client::format_of(entry.path())));
      (void)quantization_box(mesh.positions);
    } catch (const std::exception&) {
      continue;  // every_real_mesh_test looks at what cannot be read, or is too small
    }
    SCOPED_TRACE(entry.path());
    for (int level = 0; level <= 3 && mesh.topology.face_count() <= most_faces; ++level) {
      if (level > 0) mesh = refine(std::move(mesh), {.levels = 1}).mesh;
      ++(is_the_same(mesh, {.position_bits = 11, .speed = GetParam()}) ? own : left);
    }
  }
  EXPECT_GT(own, 8 * left);
  RecordProperty("own", own);
  RecordProperty("left_to_libdraco", left);
}

INSTANTIATE_TEST_SUITE_P(Edgebreaker, EdgebreakerAtSpeed, testing::Values(3, 7));

/// What a decoder makes of a stream: each face by the grid points of its corners, in no order.
std::vector<std::array<Vec3f, 3>> faces_of(const std::string& draco) {
  const TriangleMesh mesh = read_draco(draco, {});
  const auto before = [](Vec3f a, Vec3f b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
  std::vector<std::array<Vec3f, 3>> faces;
  for (const Triangle& t : mesh.triangles) {
    std::array<Vec3f, 3> face{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
    std::ranges::rotate(face, std::ranges::min_element(face, before));
    faces.push_back(face);
  }
  std::ranges::sort(faces,
                    [&](const auto& a, const auto& b) { return std::ranges::lexicographical_compare(a, b, before); });
  return faces;
}

/// Each edge between two vertices of its own, each face (there may be two sides of one) between three, and one fan of
/// faces at each vertex.
bool is_manifold(const Mesh& mesh) {
  std::set<std::pair<uint32_t, uint32_t>> pairs;
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
    pairs.insert(std::minmax(mesh.topology.origin[h], mesh.topology.tip(h)));
  const bool is_pillow = mesh.topology.face_count() == 2 && mesh.topology.vertex_count == 3;
  return pairs.size() == mesh.topology.edge_count() && mesh.topology.pinched.empty() && !is_pillow;
}

TEST(Edgebreaker, IsLibdracosOnEverySmallSurface) {
  int own = 0;
  for (uint32_t triangles = 1; triangles <= 8; ++triangles)
    for (const TriangleMesh& surface : small_surfaces(triangles)) {
      const Mesh mesh = build_mesh(surface);
      const QuantizationBox box = quantization_box(mesh.positions);
      for (int speed : {2, 5, 8}) {
        const OutputOptions options{.position_bits = 12, .speed = speed};
        const bool is_own = is_the_same(mesh, options);
        EXPECT_EQ(is_own, is_manifold(mesh));
        own += is_own ? 1 : 0;
        if (is_own) continue;
        const std::string written = write_draco(mesh, box, options);
        EXPECT_EQ(faces_of(written), faces_of(write_with_libdraco(mesh, box, options)));
        EXPECT_EQ(faces_of(written).size(), mesh.topology.face_count());
      }
    }
  EXPECT_GT(own, 2000);
}

TEST(Edgebreaker, LeavesToLibdracoWhatDracoSeesOtherwise) {
  const auto is_left = [](const TriangleMesh& triangles, const OutputOptions& options = {}) {
    const Mesh mesh = build_mesh(triangles);
    const QuantizationBox box = quantization_box(mesh.positions);
    bool by_libdraco = false;
    const std::string written = write_draco(mesh, box, options, {}, &by_libdraco);
    EXPECT_EQ(read_draco(written, {}).triangles.size(), triangles.triangles.size());
    EXPECT_EQ(by_libdraco, !edgebreaker::write(mesh, box, options, 0));
    return by_libdraco;
  };
  EXPECT_FALSE(is_left(tetrahedron()));
  EXPECT_TRUE(is_left(tetrahedron(), {.normals = true}));
  EXPECT_TRUE(is_left(tetrahedron(), {.speed = 1}));
  TriangleMesh three{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}}};
  EXPECT_TRUE(is_left(three));  // faces at one edge
  TriangleMesh touching{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
  EXPECT_TRUE(is_left(touching));  // at a vertex
  TriangleMesh pillow{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}};
  EXPECT_TRUE(is_left(pillow));  // the same two vertices at several edges, once refined
}

}  // namespace
}  // namespace papilio::proto
