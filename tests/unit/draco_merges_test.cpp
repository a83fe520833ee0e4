#include "proto/draco_merges.h"

#include <gtest/gtest.h>

#include "papilio/refine.h"
#include "proto/draco_reader.h"
#include "proto/draco_writer.h"
#include "proto/problem.h"
#include "tests/support/crowded_meshes.h"
#include "tests/support/shapes.h"

namespace papilio::proto {
namespace {

using namespace test;

uint64_t count_renumbered(const std::string& draco) {
  return count_renumbered_corners(draco, read_draco_header(draco, {}));
}

// Each symbol adds a face at the vertex: three for each merged triangle.
TEST(DracoMerges, CountOfRenumberedCornersEqualsTheClosedForm) {
  for (uint32_t triangles : {2U, 3U, 10U, 100U}) {
    uint64_t expected = 0;
    for (uint32_t i = 1, faces = 1; i < triangles; ++i) {
      expected += faces;
      faces += 3;
    }
    EXPECT_EQ(count_renumbered(merging_stream(triangles)), expected) << triangles;
  }
}

// Both traversals write the same symbols.
TEST(DracoMerges, CountIsEqualForBothTraversals) {
  std::mt19937 random(23);
  uint64_t all = 0;
  for (int i = 0; i < 60; ++i) {
    Mesh mesh = build_mesh(random_manifold(random));
    while (mesh.topology.face_count() < 1000) mesh = refine(std::move(mesh), {.levels = 1}).mesh;
    const QuantizationBox box = quantization_box(mesh.positions);
    const uint64_t renumbered = count_renumbered(write_draco(mesh, box, {.speed = 7}));
    EXPECT_EQ(count_renumbered(write_draco(mesh, box, {.speed = 3})), renumbered);
    all += renumbered;
  }
  EXPECT_GT(all, 1000U);
}

TEST(DracoMerges, StreamThatRenumbersQuadraticallyIsRefused) {
  EXPECT_EQ(read_draco(merging_stream(1000), {}).triangles.size(), 3997U);
  try {
    (void)read_draco(merging_stream(100'000), {});
    FAIL();
  } catch (const Problem& problem) {
    EXPECT_EQ(problem.code(), Code::mesh_unsupported);
    EXPECT_STREQ(
        problem.what(),
        "Decoding the Draco stream would renumber more than 134217728 corners: it merges vertices of many faces "
        "too often. Encode the mesh again.");
  }
}

TEST(DracoMerges, CrowdedMeshesAreAccepted) {
  for (const TriangleMesh& mesh : {faces_at_one_edge(60'000), triangles_at_one_vertex(60'000), shuffled_cone(60'000)})
    EXPECT_EQ(read_draco(write_draco_exact(mesh), {}).triangles.size(), 60'000U);
}

}  // namespace
}  // namespace papilio::proto
