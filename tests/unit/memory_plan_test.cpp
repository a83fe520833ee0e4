#include "core/hierarchy/memory_plan.h"

#include <gtest/gtest.h>

#include "papilio/refine.h"
#include "tests/support/charts.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

uint64_t points_of(const Mesh& mesh) {
  return mesh.attributes.empty() ? mesh.topology.vertex_count : mesh.attributes.point_count;
}

const std::vector<TriangleMesh>& planned_meshes() {
  static const std::vector<TriangleMesh> all{torus(8, 6),    grid(3, 4),   fan(7, false),
                                             charted_cube(), bipyramid(9), charted_faces(icosahedron())};
  return all;
}

TEST(MemoryPlan, PointsOfAUniformResultAreExact) {
  for (size_t i = 0; i < planned_meshes().size(); ++i) {
    const Mesh coarse = build_mesh(planned_meshes()[i]);
    const MemoryPlan plan(coarse, {});
    for (int level = 0; level <= 4; ++level) {
      const Mesh fine = refine(coarse, {.levels = level}).mesh;
      EXPECT_EQ(plan.points(fine.topology.face_count(), level), points_of(fine)) << i << " at level " << level;
    }
  }
}

TEST(MemoryPlan, AdaptiveResultsHaveNoMorePoints) {
  for (size_t i = 0; i < planned_meshes().size(); ++i)
    for (const Scheme scheme : {Scheme::red_green, Scheme::in_place})
      for (const double tolerance : {0.03, 0.01, 0.003}) {
        const Mesh coarse = build_mesh(planned_meshes()[i]);
        const Result fine =
            refine(coarse, {.levels = 5, .scheme = scheme, .tension = Tension::off, .tolerance = tolerance});
        EXPECT_GE(MemoryPlan(coarse, {}).points(fine.mesh.topology.face_count(), fine.levels), points_of(fine.mesh))
            << i;
      }
}

TEST(MemoryPlan, NonManifoldResultsHaveNoMorePoints) {
  const TriangleMesh book{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
  const Mesh coarse = build_mesh(book);
  const MemoryPlan plan(coarse, {});
  for (int level = 1; level <= 4; ++level) {
    const Mesh fine = refine(coarse, {.levels = level}).mesh;
    EXPECT_GE(plan.points(fine.topology.face_count(), level), points_of(fine));
  }
}

TEST(MemoryPlan, OutputBytesAreCounted) {
  const Mesh coarse = build_mesh(torus(8, 6));
  Options options{.levels = 3};
  const uint64_t faces = 64ULL * coarse.topology.face_count();
  const uint64_t without = MemoryPlan(coarse, options).given(faces, 3);
  options.output = {.face = 100, .point = 1000};
  const MemoryPlan plan(coarse, options);
  EXPECT_EQ(plan.given(faces, 3), without + 100 * faces + 1000 * plan.points(faces, 3));
  options.memory_limit = plan.given(faces, 3) - 1;
  EXPECT_THROW((void)refine(coarse, options), Error);
  options.memory_limit += 1;
  EXPECT_NO_THROW((void)refine(coarse, options));
}

}  // namespace
}  // namespace papilio
