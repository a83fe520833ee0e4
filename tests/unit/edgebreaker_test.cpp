#include "proto/edgebreaker/writer.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "client/mesh_file/mesh_file.h"
#include "core/refine.h"
#include "proto/draco_reader.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"

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

TEST(Edgebreaker, IsLibdracosOnAllRealMeshesThatItTakes) {
  int own = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(std::getenv("PAPILIO_MESHES")) / "cgal")) {
    try {
      const Mesh coarse = build_mesh(client::read_triangles(entry.path(), client::format_of(entry.path())));
      if (coarse.topology.face_count() > 30000) continue;
      for (int speed : {3, 7}) own += is_the_same(coarse, {.speed = speed}) ? 1 : 0;
      const Mesh fine = refine(coarse, {.levels = 1}).mesh;
      own += is_the_same(fine, {.position_bits = 11}) ? 1 : 0;
    } catch (const std::exception&) {
      // every_real_mesh_test looks at what cannot be read, or is too small.
    }
  }
  EXPECT_GT(own, 100);
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
