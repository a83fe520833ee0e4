#include "core/mesh/shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/mesh/hinge.h"
#include "core/rules/shape_rules.h"
#include "papilio/refine.h"
#include "papilio/trigonometry.h"
#include "server/samples/models.h"
#include "tests/gallery/harm.h"
#include "tests/support/bumpy_sphere.h"
#include "tests/support/grid_positions.h"
#include "tests/support/invariants.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"
#include "tests/support/uniform_hierarchy.h"

namespace papilio::test {
namespace {

Mesh refined(const TriangleMesh& mesh, Shape shape = Shape::automatic) {
  return refine(build_mesh(mesh), {.levels = 3, .shape = shape}).mesh;
}

double radius(Vec3f p) { return std::hypot(double{p.x}, double{p.y}); }

/// Returns the smallest radius of the outer wall of a drum of radius 1 and height 0.5.
double least_radius_of_wall(const Mesh& mesh) {
  double least = 2;
  for (Vec3f p : mesh.positions)
    if (p.z > 0.01F && p.z < 0.49F && radius(p) > 0.8) least = std::min(least, radius(p));
  return least;
}

/// A square sheet with a small round hole: slivers between its rim and the corners.
TriangleMesh sheet_with_hole() {
  constexpr uint32_t quarter = 12;
  constexpr uint32_t n = 4 * quarter;
  TriangleMesh sheet;
  for (uint32_t i = 0; i < n; ++i) {
    const SineCosine turn = sine_and_cosine_of_turn(2 * i + 1, 2 * n);
    sheet.positions.push_back(to_float(0.05 * Vec3d{turn.cosine, turn.sine, 0}));
  }
  for (Vec3f corner : {Vec3f{1, 1, 0}, Vec3f{-1, 1, 0}, Vec3f{-1, -1, 0}, Vec3f{1, -1, 0}})
    sheet.positions.push_back(corner);
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t next = (i + 1) % n;
    const uint32_t corner = n + i / quarter;
    sheet.triangles.push_back({next, i, corner});
    if (next % quarter == 0) sheet.triangles.push_back({next, corner, n + next / quarter});
  }
  return sheet;
}

TEST(Shape, RefinedBoxStaysTheBox) {
  for (const TriangleMesh& shape : {cube(), box({4, 4, 1}, {1, 1, 0.1F}), box({1, 1, 6}, {1, 1, 6})}) {
    const Box before = bounding_box(build_mesh(shape).positions);
    const Mesh fine = refined(shape);
    for (Vec3f p : fine.positions) {
      const std::vector<double> gaps{p.x - before.min.x, p.y - before.min.y, p.z - before.min.z,
                                     before.max.x - p.x, before.max.y - p.y, before.max.z - p.z};
      ASSERT_NEAR(*std::ranges::min_element(gaps), 0, 1e-6);  // on a side of the box and inside of it
    }
    EXPECT_EQ(count_folds(fine), 0U);
  }
}

TEST(Shape, ReportHasComponentsMechanicalAndCreases) {
  EXPECT_EQ(shape_of(build_mesh(box({4, 4, 1}, {1, 1, 0.1F}))), (ShapeReport{1, 1, 8 * 4 + 4 * 1}));
  EXPECT_EQ(shape_of(build_mesh(icosahedron())), (ShapeReport{1, 0, 0}));
  EXPECT_EQ(shape_of(build_mesh(join(cube(), torus(24, 16), 5))), (ShapeReport{2, 1, 12}));
  EXPECT_EQ(shape_of(build_mesh(cube()), {.shape = Shape::organic}), (ShapeReport{1, 0, 0}));
  EXPECT_EQ(shape_of(build_mesh(icosahedron()), {.shape = Shape::mechanical}), (ShapeReport{1, 1, 30}));
  EXPECT_EQ(shape_of(build_mesh(cube()), {.shape = Shape::plain}), ShapeReport{});
  EXPECT_EQ(shape_of(build_mesh(cube()), {.tension = Tension::off}), ShapeReport{});
  EXPECT_EQ(refine(build_mesh(cube()), {}).shape, (ShapeReport{1, 1, 12}));
  EXPECT_EQ(refine(PreparedMesh(build_mesh(cube()), {}, 0), {.tolerance = 0.1}).shape, (ShapeReport{1, 1, 12}));
}

/// A square base of two triangles, and an apex above it.
TriangleMesh pyramid(Vec3f apex) {
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, apex},
          {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
}

TEST(Shape, PyramidsAreMechanicalAndPlatonicSolidsAreNot) {
  EXPECT_EQ(shape_of(build_mesh(pyramid({0.5F, 0.5F, 1}))), (ShapeReport{1, 1, 8}));
  for (Vec3f apex : {Vec3f{0.5F, 0.5F, 1}, Vec3f{0.2F, 0.7F, 0.6F}}) {
    const Mesh coarse = build_mesh(pyramid(apex));
    const Mesh fine = refined(pyramid(apex));
    EXPECT_LT(rms_distance(fine, coarse), 1e-7);
    EXPECT_EQ(count_folds(fine), count_folds(coarse) << 3);
  }
  EXPECT_EQ(shape_of(build_mesh(tetrahedron())).mechanical, 0U);
  EXPECT_EQ(shape_of(build_mesh(octahedron())).mechanical, 0U);
  EXPECT_EQ(shape_of(build_mesh(icosahedron())).mechanical, 0U);
}

/// A closed vase of `n` sides with a flat bottom and top of n triangles each, and a round wall of twisted rings.
TriangleMesh vase(uint32_t n, uint32_t rings) {
  TriangleMesh mesh;
  for (uint32_t r = 0; r <= rings; ++r)
    for (uint32_t i = 0; i < n; ++i) {
      const SineCosine turn = sine_and_cosine_of_turn(2 * i + r, 2 * n);
      const double height = static_cast<double>(r) / rings;
      const double radius = 1 + 0.3 * height * (1 - height);
      mesh.positions.push_back(to_float({radius * turn.cosine, radius * turn.sine, 0.8 * height}));
    }
  const auto bottom = static_cast<uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {{0, 0, 0}, {0, 0, 0.8F}});
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t next = (i + 1) % n;
    mesh.triangles.push_back({next, i, bottom});
    mesh.triangles.push_back({rings * n + i, rings * n + next, bottom + 1});
    for (uint32_t r = 0; r < rings; ++r) {
      mesh.triangles.push_back({r * n + i, r * n + next, (r + 1) * n + next});
      mesh.triangles.push_back({r * n + i, (r + 1) * n + next, (r + 1) * n + i});
    }
  }
  return mesh;
}

TEST(Shape, ShareOfFlatAndSharpEdgesMakesMechanical) {
  // A sixth of its edges is flat and a sixth sharp; with more rings a fifteenth each.
  EXPECT_EQ(shape_of(build_mesh(vase(48, 3))), (ShapeReport{1, 1, 96}));
  EXPECT_EQ(shape_of(build_mesh(vase(48, 9))).mechanical, 0U);
  for (Vec3f p : refined(vase(48, 3)).positions) ASSERT_TRUE(p.z >= 0 && p.z <= 0.8F) << p.z;
}

// The ends of an organic vase stay flat, and their rims become rounder.
TEST(Shape, RimsOfLidsInOrganicComponentsAreCreases) {
  constexpr uint32_t sides = 48;
  const Mesh coarse = build_mesh(vase(sides, 9));
  EXPECT_EQ(shape_of(coarse), (ShapeReport{1, 0, 2 * sides}));
  EXPECT_EQ(shape_of(coarse, {.shape = Shape::organic}), (ShapeReport{1, 0, 0}));
  const Mesh fine = refined(vase(sides, 9));
  double rim = 0;
  for (Vec3f p : fine.positions) {
    ASSERT_TRUE(p.z >= 0 && p.z <= 0.8F) << p.z;
    if (p.z == 0) rim = std::max(rim, radius(p));
  }
  EXPECT_NEAR(rim, 1, 1e-3);
  EXPECT_EQ(std::ranges::count_if(fine.positions, [](Vec3f p) { return p.z == 0 && radius(p) > 0.99; }), 8 * sides);
}

TEST(Shape, RegionsWithoutASharpOutlineOrOfFewSidesAreNoLids) {
  EXPECT_EQ(shape_of(build_mesh(real_mesh("bunny600.obj"))).creases, 0U);  // a patch of it has 8 sharp sides
  EXPECT_EQ(shape_of(build_mesh(bumpy_sphere(3))).creases, 0U);
  EXPECT_EQ(shape_of(build_mesh(torus(48, 32))).creases, 0U);
}

// Sides of a dodecagon meet at 30 degrees and become round; sides of an octagon, at 45 degrees, stay flat.
TEST(Shape, DrumOfTwelveSidesBecomesRoundAndOfEightStaysFlat) {
  EXPECT_GT(least_radius_of_wall(refined(square_ring(12, 0.6F, 1, 0.5F))), 0.99);
  EXPECT_NEAR(least_radius_of_wall(refined(square_ring(8, 0.6F, 1, 0.5F))), std::cos(std::acos(-1.0) / 8), 1e-6);
}

// The wall leans by 11 degrees, so the bounds of faces with little room hold at the wider rim.
TEST(Shape, LidOfAConeStaysInItsPlane) {
  TriangleMesh cone = tube(24, 1, 0.05F, true);
  for (Vec3f& p : cone.positions)
    if (p.z > 0) p = {0.99F * p.x, 0.99F * p.y, p.z};
  for (Vec3f p : refined(cone).positions) EXPECT_TRUE(p.z == 0 || p.z > 0.005F) << p.z;
}

// The wall runs inwards below the upper lid. Its faces fold under the lid if they tilt by few degrees.
TEST(Shape, RimsOfAlmost120DegreesDoNotFold) {
  for (uint32_t sides : {12U, 16U, 48U})
    for (float degrees : {108.0F, 114.0F, 116.0F, 118.0F}) {
      TriangleMesh bowl = tube(sides, 1, 0.05F, true);
      const float narrower = 1 - 0.05F * std::tan((degrees - 90) / 57.29578F);
      for (Vec3f& p : bowl.positions)
        if (p.z == 0) p = {narrower * p.x, narrower * p.y, 0};
      const Mesh coarse = build_mesh(bowl);
      ASSERT_EQ(count_folds(coarse), 0U);
      EXPECT_EQ(count_folds(refined(bowl)), 0U) << sides << " sides, " << degrees << " degrees";
    }
}

TEST(Shape, SliversInAPlaneDoNotFold) {
  EXPECT_GT(count_folds(refined(sheet_with_hole(), Shape::plain)), 0U);
  for (Shape shape : {Shape::automatic, Shape::organic}) {
    const Mesh fine = refined(sheet_with_hole(), shape);
    EXPECT_EQ(count_folds(fine), 0U);
    for (Vec3f p : fine.positions) ASSERT_EQ(p.z, 0);
  }
}

TEST(Shape, OpenSheetKeepsItsCornersAndStraightSides) {
  for (Vec3f p : refined(grid(3, 2)).positions) {
    ASSERT_EQ(p.z, 0);
    ASSERT_TRUE(p.x >= 0 && p.x <= 3 && p.y >= 0 && p.y <= 2);
  }
}

/// Leans a mesh, and rounds its positions to a grid of Draco's.
TriangleMesh leaning_on_grid(TriangleMesh mesh, int bits) {
  for (Vec3f& p : mesh.positions) {
    p = {0.8F * p.x - 0.6F * p.y, 0.6F * p.x + 0.8F * p.y, p.z};
    p = {0.28F * p.x - 0.96F * p.z, p.y, 0.96F * p.x + 0.28F * p.z};
  }
  mesh.positions = on_grid(mesh.positions, longest_side(mesh.positions) / ((1 << bits) - 1));
  return mesh;
}

// Rounding bends the planes: their edges turn by up to some degrees, those of slivers by any angle.
TEST(Shape, PartsOnAGridAreMechanical) {
  const TriangleMesh part = join(square_ring(48, 0.6F, 1, 0.3F), box({5, 5, 2}, {1, 1, 0.3F}), 3);
  const ShapeReport exact = shape_of(build_mesh(part));
  ASSERT_EQ(exact.mechanical, 2U);
  for (const int bits : {10, 11, 12, 14}) {
    const ShapeReport rounded = shape_of(build_mesh(leaning_on_grid(part, bits)));
    EXPECT_EQ(rounded.mechanical, 2U) << bits;
    EXPECT_NEAR(rounded.creases, exact.creases, 0.15 * exact.creases) << bits;
  }
}

// At a few steps an edge most hinges are as flat as rounding may make them.
TEST(Shape, SmoothShapesOnACoarseGridAreNotMechanical) {
  for (const int bits : {8, 9, 10, 12}) {
    EXPECT_EQ(shape_of(build_mesh(leaning_on_grid(bumpy_sphere(5), bits))).mechanical, 0U) << bits;
    EXPECT_EQ(shape_of(build_mesh(leaning_on_grid(torus(96, 48), bits))).mechanical, 0U) << bits;
  }
}

TEST(Shape, MechanicalOptionKeepsEverySharpEdge) {
  const Mesh coarse = build_mesh(icosahedron());
  const Mesh fine = refined(icosahedron(), Shape::mechanical);
  const double height =
      0.7557613141 / 0.9510565163 * length(to_double(coarse.positions[0]));  // distance of a face from the centre
  for (uint32_t f = 0; f < fine.topology.face_count(); ++f) {
    const auto at = [&](uint32_t i) { return to_double(fine.positions[fine.topology.origin[3 * f + i]]); };
    const Vec3d normal = cross(at(1) - at(0), at(2) - at(0));
    ASSERT_NEAR(dot(normal, at(0)) / length(normal), height, 1e-5);
  }
}

TEST(Shape, SmoothShapesEqualThePlainRules) {
  const Mesh sphere = refine(build_mesh(icosahedron()), {.levels = 2, .tension = Tension::off}).mesh;
  for (const TriangleMesh& shape : {sphere.triangles(), torus(24, 16)})
    EXPECT_EQ(refined(shape).positions, refined(shape, Shape::plain).positions);
}

TEST(Shape, CreaseAngleOverridesTheRules) {
  const Mesh coarse = build_mesh(cube());
  EXPECT_EQ(refine(coarse, {.crease_angle = 60}).shape.creases, 12U);
  const Result round = refine(coarse, {.levels = 3, .crease_angle = 100});
  EXPECT_EQ(round.shape.creases, 0U);
  EXPECT_NE(round.mesh.positions, refined(cube()).positions);
}

TEST(Shape, ShapeHasNoEffectWithoutTension) {
  const Mesh coarse = build_mesh(cube());
  for (Shape shape : {Shape::automatic, Shape::organic, Shape::mechanical})
    EXPECT_EQ(refine(coarse, {.tension = Tension::off, .shape = shape}).mesh.positions,
              refine(coarse, {.tension = Tension::off, .shape = Shape::plain}).mesh.positions);
}

// Neighbours of moved edges move one level later.
TEST(Shape, ToleranceIsReachedIfFlatRegionsBendAtLaterLevels) {
  for (const TriangleMesh& shape : {server::mug(), server::wheel()}) {
    const Mesh coarse = build_mesh(shape);
    const double tolerance = 1e-4;
    const Result result = refine(coarse, {.levels = 8, .tolerance = tolerance});
    EXPECT_GT(result.shape.mechanical, 0U);
    EXPECT_EQ(result.stop_reason, StopReason::converged);
    EXPECT_LE(result.error, tolerance);
  }
}

// One side of the sheet is long; the next edges turn by 20 degrees each.
TEST(Shape, ShortEdgeAfterALongOneStaysNearItsMidpoint) {
  TriangleMesh sheet{{{0, 1, 0}, {-9, 0, 0}, {0, 0, 0}}, {}};
  for (uint32_t i = 1; i < 5; ++i) {
    const SineCosine turn = sine_and_cosine_of_turn(i, 18);
    sheet.positions.push_back(sheet.positions.back() + to_float(0.3 * Vec3d{turn.cosine, turn.sine, 0}));
  }
  for (uint32_t i = 2; i < sheet.positions.size(); ++i) sheet.triangles.push_back({0, i - 1, i});
  const Mesh coarse = build_mesh(sheet);
  const Result fine = refine(coarse, {.levels = 1});
  EXPECT_EQ(fine.shape.mechanical, 1U);
  const Vec3f middle = 0.5F * (sheet.positions[2] + sheet.positions[3]);
  float nearest = 1;
  for (Vec3f p : fine.mesh.positions) nearest = std::min(nearest, length(p - middle));
  EXPECT_LT(nearest, 0.3 * 0.05);
}

class ShapeOnRealMeshes : public ::testing::TestWithParam<const char*> {};

TEST_P(ShapeOnRealMeshes, AdaptiveVerticesAreUniformAndNoFaceFolds) {
  const Mesh coarse = build_mesh(real_mesh(GetParam()));
  for (Tension tension : {Tension::soft, Tension::sharp}) {
    Options options{.levels = 3, .tension = tension};
    const UniformHierarchy uniform(coarse, options);
    const uint32_t coarse_folds = count_folds(refine(coarse, {.levels = 0}).mesh);
    EXPECT_LE(count_folds(refine(coarse, options).mesh), coarse_folds << options.levels);
    for (double tolerance : {1e-3, 1e-4}) {
      options.tolerance = tolerance;
      const Result result = refine(coarse, options);
      EXPECT_TRUE(is_consistent(result.mesh));
      EXPECT_GT(result.shape.mechanical, 0U);
      EXPECT_TRUE(uniform.contains(result.mesh));
      const PreparedMesh prepared(coarse, options, 1'000'000'000);
      EXPECT_EQ(refine(prepared, options).mesh.triangles(), result.mesh.triangles());
      Options in_place = options;
      in_place.scheme = Scheme::in_place;
      EXPECT_TRUE(is_consistent(refine(coarse, in_place).mesh));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShapeOnRealMeshes,
                         ::testing::Values("cgal/anchor.off", "cgal/joint.off", "cgal/pinion_small.off",
                                           "cgal/couplingdown.off", "cgal/rotor_small.off", "cgal/dragknob.off",
                                           "cgal/part.off", "cgal/mpi.off", "cgal/bones.off", "cgal/boeing.off"));

TEST(Hinge, ApexInTheLargerFacesPlaneIsFlat) {
  // A sliver whose normal is not reliable.
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0.5F, 1, 0}, {0.5F, 0, 1e-7F}}, {{0, 1, 2}, {1, 0, 3}}};
  const Mesh built = build_mesh(mesh);
  uint32_t h = 0;
  while (built.topology.twin[h] == none) ++h;
  const Hinge hinge(built.topology, built.positions, h);
  EXPECT_NEAR(hinge.cosine(), 0, 1e-6);
  EXPECT_TRUE(hinge.is_flat(2e-7));
  EXPECT_FALSE(hinge.is_flat(5e-8));
}

TEST(ShapeRules, BoundsKeepNewVerticesFromFoldingFaces) {
  const Vec3d a{0, 0, 0};
  const Vec3d b{2, 0, 0};
  const std::vector<FaceAtEdge> one{{{1, 1, 0}, 1}};
  const std::vector<FaceAtEdge> two{{{1, 1, 0}, 1}, {{1, -0.5, 0.3}, 0.4}};
  constexpr double any = 1e9;
  const auto expect_near = [](Vec3d found, Vec3d expected) { EXPECT_LT(length(found - expected), 1e-15); };
  expect_near(keep_unfolded({0.1, 0.1, 0.1}, a, b, one, any), {0.1, 0.1, 0.1});
  expect_near(keep_unfolded({0.1, 0.5, 0.3}, a, b, one, any), {0.1, 0.2, 0.3});    // clamped towards the face
  expect_near(keep_unfolded({0.1, -0.5, 0.3}, a, b, one, any), {0.1, -0.5, 0.3});  // away from the face: unchanged
  expect_near(keep_unfolded({0.3, 0.3, 0.4}, a, b, one, 0.1),
              {0.3, 0.1 * 0.2 / std::hypot(0.2, 0.4), 0.1 * 0.4 / std::hypot(0.2, 0.4)});
  for (Vec3d off : {Vec3d{0.1, 0.5, 0.3}, Vec3d{-0.4, -0.7, 0.9}, Vec3d{0, 0.3, -2}}) {
    const Vec3d kept = keep_unfolded(off, a, b, two, mechanical_across_bound);
    EXPECT_EQ(kept, keep_unfolded(off, b, a, two, mechanical_across_bound));
    EXPECT_EQ(kept, keep_unfolded(off, a, b, std::vector{two[1], two[0]}, mechanical_across_bound));
    EXPECT_LE(std::hypot(kept.y, kept.z), mechanical_across_bound * 0.4 + 1e-15);
    EXPECT_EQ(keep_unfolded(off, a, a, two, any), off);  // edge of zero length
  }
}

TEST(ShapeRules, MovesAcrossSharedEdgesAreShortenedInEveryDirection) {
  const Vec3d a{0, 0, 0};
  const Vec3d b{2, 0, 0};
  const Vec3d off{0.3, -0.3, 0.4};
  EXPECT_EQ(shorten_across(off, a, b, 0.6), off);
  EXPECT_LT(length(shorten_across(off, a, b, 0.25) - Vec3d{0.3, -0.15, 0.2}), 1e-15);
  EXPECT_EQ(shorten_across(off, a, b, 0.25), shorten_across(off, b, a, 0.25));
  EXPECT_EQ(shorten_across(off, a, a, 0), off);  // an edge without length
}

TEST(ShapeRules, SmallClearanceKeepsNewVerticesNearThePlanes) {
  const Vec3d a{0, 0, 0};
  const Vec3d b{2, 0, 0};
  const auto expect_near = [](Vec3d found, Vec3d expected) { EXPECT_LT(length(found - expected), 1e-15); };
  const FaceAtEdge ahead{{1, 1, 0}, 1, 0.5};
  const FaceAtEdge behind{{1, -1, 0}, 1, 0.5};
  const FaceAtEdge below{{1, 0, -1}, 1, 0.5};
  expect_near(keep_unfolded({0.1, -0.1, 0.3}, a, b, std::vector{ahead}, 0.4), {0.1, -0.2 / 3, 0.2});
  expect_near(keep_unfolded({0.1, 0, 0.3}, a, b, std::vector{ahead, behind}, 0.4), {0.1, 0, 0.2});
  const Vec3d off{0.1, -0.3, 0.3};
  const Vec3d kept = keep_unfolded(off, a, b, std::vector{ahead, below}, 0.4);
  expect_near(kept, {0.1, -0.2, 0.2});
  expect_near(keep_unfolded({0.1, -0.1, 0.3}, a, b, std::vector{ahead, below}, 0.4), {0.1, -0.2 / 3, 0.2});
  EXPECT_EQ(kept, keep_unfolded(off, b, a, std::vector{below, ahead}, 0.4));
  EXPECT_EQ(room_on_curves(0), 1);  // the rim of a drum
  EXPECT_LT(room_on_curves(-0.3), 0.3);
  EXPECT_LT(room_in_faces(0), 0.5);
  EXPECT_GT(room_in_faces(-0.49), 0);
  EXPECT_EQ(room_in_faces(-0.5), 0);  // a fold
  expect_near(keep_unfolded({0.1, 0.2, 0.3}, a, b, std::vector<FaceAtEdge>{{{1, 1, 0}, 0}}, 0.4), {0.1, 0, 0});
}

}  // namespace
}  // namespace papilio::test
