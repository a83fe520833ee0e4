#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/detail/base_lift.h"
#include "core/detail/collapse_sequence.h"
#include "core/detail/detail_level.h"
#include "core/detail/error_weights.h"
#include "core/detail/folds.h"
#include "core/detail/surface_distance.h"
#include "core/detail/surface_walk.h"
#include "papilio/refine.h"
#include "tests/support/invariants.h"
#include "tests/support/shapes.h"

// Parts of the encoder of detail.

namespace papilio {
namespace {

/// A fine sphere of radius 1 about the origin.
TriangleMesh sphere(int levels) {
  Options options;
  options.levels = levels;
  options.tension = Tension::off;
  TriangleMesh mesh = refine(build_mesh(test::icosahedron()), options).mesh.triangles();
  for (Vec3f& p : mesh.positions) p = (1 / length(p)) * p;
  return mesh;
}

TEST(SurfaceTree, NearestPointEqualsALinearSearch) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(-2, 2);
  const TriangleMesh torus = test::torus(12, 8);
  const SurfaceTree tree(torus);
  for (int i = 0; i < 2000; ++i) {
    const Vec3d point{place(random), place(random), place(random)};
    double least = 1e300;
    for (uint32_t f = 0; f < torus.triangles.size(); ++f)
      least = std::min(least, squared_distance(point, tree.corners(f)));
    const Nearest found = tree.nearest(point);
    EXPECT_NEAR(found.squared_distance, least, 1e-12);
    EXPECT_NEAR(dot(found.point - point, found.point - point), least, 1e-12);
    EXPECT_NEAR(squared_distance(found.point, tree.corners(found.face)), 0, 1e-12);
    EXPECT_EQ(tree.nearest(point, 0.99 * std::sqrt(least)).face, none);
    EXPECT_EQ(tree.nearest(point, 1.01 * std::sqrt(least)).face, found.face);
  }
}

TEST(SurfaceTree, NearestPointIsOnAFaceOfASimilarNormal) {
  const SurfaceTree tree(test::box({4, 4, 4}, {1, 1, 1}));
  const Vec3d near_bottom{0.5, 0.5, 0.1};
  EXPECT_NEAR(tree.nearest(near_bottom).point.z, 0, 1e-12);
  EXPECT_NEAR(tree.nearest(near_bottom, 10, {0, 0, 1}).point.z, 1, 1e-12);
  EXPECT_NEAR(tree.nearest(near_bottom, 10, {1, 0, 0}).point.x, 1, 1e-12);
}

TEST(SurfaceDistance, ConcentricSpheresDifferByTheirRadii) {
  const TriangleMesh one = sphere(5);
  TriangleMesh other = one;
  for (Vec3f& p : other.positions) p = 1.1F * p;
  const SurfaceDistance found = surface_distance(SurfaceTree(one), SurfaceTree(other), 5000);
  EXPECT_NEAR(found.rms, 0.1, 2e-3);
  EXPECT_NEAR(found.largest, 0.1, 3e-3);
}

TEST(SurfaceDistance, DistanceIsSymmetricWhereAComponentIsMissing) {
  const TriangleMesh one = test::cube();
  const TriangleMesh two = test::join(one, one, 5);
  const double largest = surface_distance(SurfaceTree(one), SurfaceTree(two), 2000).largest;
  EXPECT_GT(largest, 3);
  EXPECT_DOUBLE_EQ(largest, surface_distance(SurfaceTree(two), SurfaceTree(one), 2000).largest);
}

TEST(SurfaceDistance, VertexDistanceIncludesSpikesBetweenSamples) {
  const TriangleMesh round = sphere(4);
  TriangleMesh spiked = round;
  spiked.positions[100] = 1.5F * spiked.positions[100];
  const SurfaceTree one(round), other(spiked);
  EXPECT_LT(surface_distance(one, other, 200).largest, 0.4);
  EXPECT_NEAR(vertex_distance(one, other), 0.5, 1e-6);
  EXPECT_DOUBLE_EQ(vertex_distance(one, other), vertex_distance(other, one));
}

TEST(Folds, OppositeSheetOfAThinPartIsNoFold) {
  const TriangleMesh sheet = test::grid(9, 9);
  TriangleMesh lower = test::join(sheet, sheet, 0);
  for (size_t i = sheet.positions.size(); i < lower.positions.size(); ++i) lower.positions[i].z -= 0.01F;
  for (size_t f = sheet.triangles.size(); f < lower.triangles.size(); ++f)
    std::swap(lower.triangles[f][0], lower.triangles[f][1]);
  const OriginalSurface original(build_mesh(lower));
  TriangleMesh moved = sheet;  // nearer to the other sheet
  for (Vec3f& p : moved.positions) p.z -= 0.008F;
  EXPECT_EQ(find_folds(original, SurfaceTree(moved), 0.02).faces, 0U);
  EXPECT_EQ(find_folds(original, SurfaceTree(moved), 0.005).faces, moved.triangles.size());
  std::swap(moved.triangles[5][0], moved.triangles[5][1]);
  const Folds folds = find_folds(OriginalSurface(build_mesh(sheet)), SurfaceTree(moved), 0.02);
  EXPECT_EQ(folds.faces, 1U);
  EXPECT_NEAR(folds.area, 1.0 / static_cast<double>(moved.triangles.size()), 1e-6);
}

TEST(SurfaceWalk, WalkEndsAtTheIntersection) {
  const Mesh mesh = build_mesh(sphere(4));
  const SurfaceTree tree(mesh.triangles());
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 300; ++i) {
    Vec3d direction{normal(random), normal(random), normal(random)};
    direction = (1 / length(direction)) * direction;
    const Vec3d off{0.2 * normal(random) / 3, 0.2 * normal(random) / 3, 0.2 * normal(random) / 3};
    const Vec3d point = direction + off;
    const uint32_t start = tree.nearest(0.9 * direction + Vec3d{0.2, 0.1, 0}).face;
    const auto hit = walk_to_line(mesh, start, point, direction);
    ASSERT_TRUE(hit);
    const Vec3d place = point + hit->offset * direction;
    EXPECT_NEAR(squared_distance(place, tree.corners(hit->face)), 0, 1e-12);
    EXPECT_GT(dot(place, direction), 0) << "the sheet behind";
  }
}

TEST(SurfaceWalk, WalkFailsWithoutAForwardIntersection) {
  const Mesh mesh = build_mesh(sphere(3));
  const SurfaceTree tree(mesh.triangles());
  const uint32_t top = tree.nearest({0, 0, 2}).face;
  EXPECT_TRUE(walk_to_line(mesh, top, {0.5, 0, 0}, {0, 0, 1}));
  EXPECT_FALSE(walk_to_line(mesh, top, {1.5, 0, 0}, {0, 0, 1})) << "the line passes the sphere";
  EXPECT_FALSE(walk_to_line(mesh, top, {0.5, 0, 0}, {0, 0, -1})) << "the face has the opposite normal";
}

class Collapses : public ::testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] static TriangleMesh shape() {
    const std::string name = GetParam();
    if (name == "sphere") return sphere(4);
    if (name == "torus") return test::torus(64, 32);
    if (name == "box") return test::box({12, 12, 12}, {1, 2, 3});
    return test::join(sphere(3), test::torus(40, 20), 4);
  }
};

TEST_P(Collapses, CollapsesKeepTheTopologyAndVerticesOfTheOriginal) {
  const Mesh original = build_mesh(shape());
  CollapseSequence sequence(original);
  for (const uint32_t faces : {800U, 200U, 100U, 0U}) {
    sequence.collapse_to(faces);
    const BaseMesh base = sequence.base();
    if (faces > 0) {
      EXPECT_LE(base.face.size(), faces);
    }
    const Mesh mesh = build_mesh(base.triangles);
    EXPECT_TRUE(test::is_consistent(mesh));
    EXPECT_EQ(mesh.topology.face_count(), base.face.size());
    EXPECT_EQ(mesh.topology.euler_characteristic(), original.topology.euler_characteristic());
    EXPECT_TRUE(std::ranges::all_of(mesh.topology.kind, [](EdgeKind kind) { return kind == EdgeKind::smooth; }));
    EXPECT_TRUE(mesh.topology.pinched.empty());
    for (uint32_t v = 0; v < base.vertex.size(); ++v)
      EXPECT_EQ(base.triangles.positions[v], original.positions[base.vertex[v]]);
  }
}

TEST_P(Collapses, LiftIsABijectionThatKeepsVertices) {
  const OriginalSurface original(build_mesh(shape()));
  CollapseSequence sequence(original.mesh());
  sequence.collapse_to(150);
  const BaseMesh base = sequence.base();
  // Corners of a face map to its vertices.
  std::vector<SurfacePlace> corners;
  for (const uint32_t face : base.face)
    for (const Vec3d weights : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) corners.push_back({face, weights});
  sequence.lift(corners, base);
  for (size_t i = 0; i < corners.size(); ++i) {
    const uint32_t v = base.triangles.triangles[i / 3][i % 3];
    EXPECT_LT(length(original.point(corners[i]) - to_double(base.triangles.positions[v])), 1e-5);
  }
  // Dyadic points of the base form a surface on the original that covers it.
  constexpr int levels = 4;
  const LiftedBase lifted = lift_base(sequence, base, {.triangles = base.triangles}, original, levels, {});
  DetailLevel level(lifted.mesh.topology);
  TriangleMesh surface{.positions = lifted.mesh.positions, .triangles = {}};
  for (const auto& places : lifted.places) {
    ASSERT_EQ(places.size(), level.topology().edge_count());
    for (const OriginalPlace& place : places) {
      EXPECT_NEAR(squared_distance(to_double(place.point), original.tree().corners(place.face)), 0, 1e-9);
      surface.positions.push_back(place.point);
    }
    level = level.next();
  }
  for (uint32_t h = 0; h < level.topology().half_edge_count(); h += 3)
    surface.triangles.push_back(
        {level.topology().origin[h], level.topology().origin[h + 1], level.topology().origin[h + 2]});
  const SurfaceDistance distance = surface_distance(original.tree(), SurfaceTree(surface), 5000);
  EXPECT_LT(distance.rms, 0.01 * original.diagonal());
  EXPECT_LT(distance.largest, 0.06 * original.diagonal());
}

INSTANTIATE_TEST_SUITE_P(Shapes, Collapses, ::testing::Values("sphere", "torus", "box", "two_components"),
                         [](const auto& shape) { return std::string(shape.param); });

// Each collapse at a rim looked for one at the lid's centre, in the square of its faces: 10 s in place of .06.
TEST(CollapseSequence, LidsOfManyFacesAreSimplified) {
  const Mesh original = build_mesh(test::tube(1000, 4, 0.5F, true));
  CollapseSequence sequence(original);
  sequence.collapse_to(100);
  const BaseMesh base = sequence.base();
  EXPECT_LE(base.face.size(), 100U);
  EXPECT_EQ(build_mesh(base.triangles).topology.euler_characteristic(), 2);
}

TEST(Encoder, LongSearchesCanBeStopped) {
  struct Stop {};
  const Poller stop([] { throw Stop(); });
  const OriginalSurface original(build_mesh(sphere(5)));
  const SurfaceTree& tree = original.tree();
  std::vector<float> weights;
  ASSERT_GT(original.mesh().positions.size(), 10'000U);
  EXPECT_THROW((void)CollapseSequence(original.mesh(), {}, stop), Stop);
  EXPECT_THROW((void)surface_distance(tree, tree, 10'000, stop), Stop);
  EXPECT_THROW((void)vertex_distance(tree, tree, stop), Stop);
  EXPECT_THROW((void)find_folds(original, tree, 0.1, stop), Stop);
  EXPECT_THROW(weigh_errors(original, tree.surface(), weights, stop), Stop);
}

TEST(BaseLift, OtherBaseIsRefused) {
  const OriginalSurface original(build_mesh(sphere(3)));
  CollapseSequence sequence(original.mesh());
  sequence.collapse_to(100);
  const BaseMesh base = sequence.base();
  TriangleMesh merged = base.triangles;
  for (Vec3f& p : merged.positions) p = {std::round(p.x), std::round(p.y), std::round(p.z)};
  EXPECT_THROW((void)lift_base(sequence, base, {.triangles = merged}, original, 1, {}), Error);
}

}  // namespace
}  // namespace papilio
