#include "core/detail/distant_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/detail/base_lift.h"
#include "core/detail/collapse_sequence.h"
#include "core/detail/folds.h"
#include "core/detail/placement.h"
#include "core/detail/residual_fit.h"
#include "core/detail/surface_distance.h"
#include "papilio/error.h"
#include "tests/support/bumpy_sphere.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

constexpr int levels = 3;
constexpr float step = 0.002F;

/// Fine sphere with thorns at some vertices, two edges high and two wide.
TriangleMesh thorny_sphere() {
  TriangleMesh mesh = test::bumpy_sphere(5);
  for (size_t v = 100; v < mesh.positions.size(); v += 1000) mesh.positions[v] = 1.08F * mesh.positions[v];
  return mesh;
}

/// Fine sphere with many thorns, and a lower one beside each, which the same vertices could reach.
TriangleMesh sphere_of_double_thorns() {
  TriangleMesh mesh = test::bumpy_sphere(5);
  std::vector<std::vector<uint32_t>> beside(mesh.positions.size());
  for (const Triangle& t : mesh.triangles)
    for (size_t i = 0; i < 3; ++i) beside[t[i]].push_back(t[(i + 1) % 3]);
  for (uint32_t v = 100; v < mesh.positions.size(); v += 300) {
    const std::vector<uint32_t>& near = beside[beside[v][0]];
    const uint32_t lower = beside[near[0] == v ? near[1] : near[0]][1];
    mesh.positions[v] = 1.12F * mesh.positions[v];
    if (lower != v) mesh.positions[lower] = 1.06F * mesh.positions[lower];
  }
  return mesh;
}

/// Levels of a coarse base, with their residuals.
struct Hierarchy {
  explicit Hierarchy(const TriangleMesh& triangles) : original(build_mesh(triangles)), sequence(original.mesh()) {
    sequence.collapse_to(300);
    base = sequence.base();
    lifted = lift_base(sequence, base, {.triangles = base.triangles}, original, levels, {});
  }
  [[nodiscard]] ResidualFit fit() const {
    return {original, lifted.mesh.positions, place_on_original(original, lifted, levels, {.last = step}, {}), {}};
  }
  [[nodiscard]] double largest_distance(const ResidualFit& fit) const {
    return vertex_distance(original.tree(), SurfaceTree(fit.surface(levels)));
  }
  OriginalSurface original;
  CollapseSequence sequence;
  BaseMesh base;
  LiftedBase lifted;
};

TEST(DistantPoints, ThornsAreReached) {
  const Hierarchy hierarchy(thorny_sphere());
  ResidualFit fit = hierarchy.fit();
  const double before = hierarchy.largest_distance(fit);
  const double rms = surface_distance(hierarchy.original.tree(), SurfaceTree(fit.surface(levels)), 20'000).rms;
  const double most = before / 3;
  reach_distant_points(fit, hierarchy.original, {.most = most, .sheet_reach = 2 * step}, {});
  EXPECT_LT(hierarchy.largest_distance(fit), 1.2 * most);
  EXPECT_LT(surface_distance(hierarchy.original.tree(), SurfaceTree(fit.surface(levels)), 20'000).rms, rms);
}

TEST(DistantPoints, NoFaceIsTurnedOver) {
  const Hierarchy hierarchy(thorny_sphere());
  ResidualFit fit = hierarchy.fit();
  const uint32_t folds = find_folds(hierarchy.original, SurfaceTree(fit.surface(levels)), 2 * step).faces;
  reach_distant_points(fit, hierarchy.original, {.most = step, .sheet_reach = 2 * step}, {});
  EXPECT_LE(find_folds(hierarchy.original, SurfaceTree(fit.surface(levels)), 2 * step).faces, folds);
}

TEST(DistantPoints, MovesThatUncoverOtherTipsAreTakenBack) {
  const Hierarchy hierarchy(sphere_of_double_thorns());
  ResidualFit fit = hierarchy.fit();
  const double before = hierarchy.largest_distance(fit);
  reach_distant_points(fit, hierarchy.original, {.most = 0.2 * before, .sheet_reach = 2 * step}, {});
  EXPECT_LT(hierarchy.largest_distance(fit), 0.45 * before);  // 0.55 if they are not
}

TEST(DistantPoints, OnlyTheLastLevelMoves) {
  const Hierarchy hierarchy(thorny_sphere());
  ResidualFit fit = hierarchy.fit();
  const TriangleMesh before = fit.surface(levels);
  reach_distant_points(fit, hierarchy.original, {.most = 5 * step, .sheet_reach = 2 * step}, {});
  const TriangleMesh after = fit.surface(levels);
  const size_t coarse = fit.surface(levels - 1).positions.size();
  EXPECT_TRUE(std::equal(before.positions.begin(), before.positions.begin() + coarse, after.positions.begin()));
  EXPECT_NE(before.positions, after.positions);
}

TEST(DistantPoints, WithoutDistantPointsNothingMoves) {
  const Hierarchy hierarchy(thorny_sphere());
  ResidualFit fit = hierarchy.fit();
  const TriangleMesh before = fit.surface(levels);
  reach_distant_points(fit, hierarchy.original,
                       {.most = 1.01 * hierarchy.largest_distance(fit), .sheet_reach = 2 * step}, {});
  EXPECT_EQ(fit.surface(levels), before);
}

TEST(DistantPoints, CurvesStayInPlace) {
  TriangleMesh sheet = test::grid(40, 40);
  for (size_t v = 0; v < sheet.positions.size(); v += 97) sheet.positions[v].z = 0.05F;
  const Hierarchy hierarchy(sheet);
  ResidualFit fit = hierarchy.fit();
  const TriangleMesh before = fit.surface(levels);
  reach_distant_points(fit, hierarchy.original, {.most = step, .sheet_reach = 2 * step}, {});
  const TriangleMesh after = fit.surface(levels);
  EXPECT_NE(before.positions, after.positions);
  const DetailLevel& last = fit.level(levels - 1);
  for (const uint32_t e : last.curve_edges()) {
    const uint32_t v = last.topology().vertex_count + e;
    EXPECT_EQ(before.positions[v], after.positions[v]);
  }
}

TEST(DistantPoints, CanBeCancelled) {
  const Hierarchy hierarchy(thorny_sphere());
  ResidualFit fit = hierarchy.fit();
  EXPECT_THROW(reach_distant_points(fit, hierarchy.original, {.most = step, .sheet_reach = 2 * step},
                                    Poller([] { throw Error(Fault::cancelled, "Enough."); })),
               Error);
}

}  // namespace
}  // namespace papilio
