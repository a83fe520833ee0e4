#include "core/rules/tension.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/mesh/normals.h"
#include "core/rules/butterfly.h"
#include "papilio/refine.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"
#include "tests/support/whole_split.h"

namespace papilio {
namespace {

using namespace test;

struct Ends {
  Vec3d a, b;
  [[nodiscard]] Vec3d middle() const { return 0.5 * (a + b); }
  [[nodiscard]] double size() const { return length(b - a); }
};

Ends ends_of(const Mesh& mesh, uint32_t edge, const Buffer<Vec3d>& positions) {
  const uint32_t h = mesh.topology.half_edge[edge];
  return {positions[mesh.topology.origin[h]], positions[mesh.topology.tip(h)]};
}

TEST(Tension, HingeFactorFallsFromSixtyToNinetyDegrees) {
  EXPECT_EQ(hinge_factor(1), 1);
  EXPECT_EQ(hinge_factor(0.5), 1);
  EXPECT_EQ(hinge_factor(0), 0);
  EXPECT_EQ(hinge_factor(-1), 0);
  EXPECT_EQ(hinge_factor(0.25), 0.5);
  EXPECT_GT(hinge_factor(0.3), hinge_factor(0.2));
}

/// Returns the overshoot of the refined surface beyond the box of the mesh, as a share of `size`.
double overshoot(const TriangleMesh& triangles, Tension tension, double size) {
  const Mesh coarse = build_mesh(triangles);
  const Box before = bounding_box(coarse.positions);
  const Box after =
      bounding_box(refine(coarse, {.levels = 3, .tension = tension, .shape = Shape::plain}).mesh.positions);
  const Vec3f low = before.min - after.min;
  const Vec3f high = after.max - before.max;
  return std::max({low.x, low.y, low.z, high.x, high.y, high.z}) / size;
}

/// Expects these overshoots; `soft` within `rounding`, half of its last digit.
void expect_overshoots(const TriangleMesh& mesh, double size, double plain, double soft, double rounding = 5e-4) {
  EXPECT_NEAR(overshoot(mesh, Tension::off, size), plain, 5e-4);
  EXPECT_NEAR(overshoot(mesh, Tension::soft, size), soft, rounding);
  EXPECT_LE(overshoot(mesh, Tension::sharp, size), 1e-6);
}

TEST(Tension, OvershootsEqualTheTable) {
  {
    SCOPED_TRACE("cube");
    expect_overshoots(cube(), 1, 0.175, 0.086);
  }
  {
    SCOPED_TRACE("slab 1 x 1 x 0.1");
    expect_overshoots(box({4, 4, 1}, {1, 1, 0.1F}), 1, 0.052, 0.031);
  }
  {
    SCOPED_TRACE("bar 1 x 1 x 6, across");
    expect_overshoots(box({1, 1, 6}, {1, 1, 6}), 1, 0.217, 0.128);
  }
  {
    SCOPED_TRACE("rim of a wheel with twelve corners");
    expect_overshoots(square_ring(12, 0.65F, 1, 0.4F), 2, 0.025, 0.0002, 5e-5);
  }
}

TEST(Tension, SmoothShapesEqualThePlainScheme) {
  for (const TriangleMesh& shape : {icosahedron(), torus(12, 8)}) {
    const Mesh coarse = build_mesh(shape);
    const Mesh plain = refine(coarse, {.levels = 3, .tension = Tension::off}).mesh;
    for (Tension tension : {Tension::soft, Tension::sharp}) {
      const Mesh tensed = refine(coarse, {.levels = 3, .tension = tension, .shape = Shape::plain}).mesh;
      for (size_t v = 0; v < plain.positions.size(); ++v)
        ASSERT_LE(length(to_double(plain.positions[v]) - to_double(tensed.positions[v])), 2e-6);
    }
  }
}

TEST(Tension, TetrahedronStaysFlat) {
  // Exterior angles are 109 degrees: all factors are 0 and all new vertices are midpoints.
  const Mesh coarse = build_mesh(tetrahedron());
  const TensionField field = tension_field(coarse, face_normals(coarse), Tension::soft);
  const Buffer<Vec3d> positions = in_double(coarse);
  const auto made = new_vertices(coarse.topology, positions, {.tension = &field});
  for (uint32_t e = 0; e < made.size(); ++e) EXPECT_LE(length(made[e] - ends_of(coarse, e, positions).middle()), 1e-15);
}

/// Calls `check(edge, plain, tensed)`, with all factors 1, for each inner edge within the bound.
template <class Check>
void with_all_factors_one(const Mesh& mesh, const Buffer<Vec3d>& positions, const Check& check) {
  const TensionField ones{.factor = Buffer<float>(mesh.topology.edge_count(), 1)};
  const auto plain = new_vertices(mesh.topology, positions);
  const auto tensed = new_vertices(mesh.topology, positions, {.tension = &ones});
  for (uint32_t e = 0; e < plain.size(); ++e) {
    if (mesh.topology.kind[e] != EdgeKind::smooth) continue;
    const Ends ends = ends_of(mesh, e, positions);
    if (length(plain[e] - ends.middle()) < tension_bound * ends.size()) check(e, plain[e], tensed[e]);
  }
}

TEST(Tension, FactorsOfOneEqualThePlainScheme) {
  const auto expect_equal = [](uint32_t e, Vec3d plain, Vec3d tensed) {
    ASSERT_LE(length(plain - tensed), 1e-12 * (1 + length(plain))) << e;
  };
  for (uint32_t ring = 3; ring <= 40; ++ring) {
    const Mesh cone = build_mesh(bipyramid(ring));
    with_all_factors_one(cone, in_double(cone), expect_equal);
  }
  for (uint32_t seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    const Mesh mesh = build_mesh(random_manifold(random));
    with_all_factors_one(mesh, in_double(mesh), expect_equal);
  }
  const Mesh bunny = build_mesh(real_mesh("bunny600.obj"));
  with_all_factors_one(bunny, in_double(bunny), expect_equal);
}

TEST(Tension, IrregularVerticesAtFactorsOfOneAreBitIdenticalToPlain) {
  const Mesh mesh = refine(build_mesh(icosahedron()), {.levels = 1, .tension = Tension::off}).mesh;
  const TensionField field = tension_field(mesh, face_normals(mesh), Tension::soft);
  ASSERT_TRUE(std::ranges::all_of(field.factor, [](float factor) { return factor == 1; }));
  const Buffer<Vec3f> plain = new_vertices(mesh.topology, mesh.positions);
  const Buffer<Vec3f> tensed = new_vertices(mesh.topology, mesh.positions, {.tension = &field});
  int spokes = 0;
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
    if (mesh.topology.origin[h] >= 12) continue;  // the icosahedron's vertices, of valence 5
    EXPECT_EQ(tensed[mesh.topology.edge[h]], plain[mesh.topology.edge[h]]);
    ++spokes;
  }
  EXPECT_EQ(spokes, 60);
}

TEST(Tension, SchemeIsAffineInvariantForGivenFactors) {
  const Mesh mesh = build_mesh(real_mesh("bunny600.obj"));
  const TensionField field = tension_field(mesh, face_normals(mesh), Tension::soft);
  ASSERT_LT(*std::ranges::min_element(field.factor), 0.5F);
  const auto map = [](Vec3d p) {
    return Vec3d{1.5 * p.x + 0.25 * p.y - 0.5 * p.z + 3, 0.75 * p.y + 0.125 * p.x - 1, 1.25 * p.z + 0.5 * p.x};
  };
  const Buffer<Vec3d> before = in_double(mesh);
  Buffer<Vec3d> after = before;
  std::ranges::transform(after, after.begin(), map);
  const auto q_before = new_vertices(mesh.topology, before, {.tension = &field});
  const auto q_after = new_vertices(mesh.topology, after, {.tension = &field});
  uint32_t compared = 0;
  for (uint32_t e = 0; e < q_before.size(); ++e) {
    const Ends there = ends_of(mesh, e, before);
    const Ends here = ends_of(mesh, e, after);
    const double bound = 0.999 * tension_bound;  // lengths, and so the bound, are not affine-invariant
    if (length(q_before[e] - there.middle()) > bound * there.size()) continue;
    if (length(q_after[e] - here.middle()) > bound * here.size()) continue;
    ASSERT_LE(length(map(q_before[e]) - q_after[e]), 1e-12 * (1 + length(q_after[e]))) << e;
    ++compared;
  }
  EXPECT_GT(compared, q_before.size() / 2);
}

TEST(Tension, MovesAreWithinTheBound) {
  for (uint32_t seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    const Mesh mesh = build_mesh(random_manifold(random));
    const Buffer<Vec3d> positions = in_double(mesh);
    for (Tension tension : {Tension::soft, Tension::sharp}) {
      const TensionField field = tension_field(mesh, face_normals(mesh), tension);
      const auto made = new_vertices(mesh.topology, positions, {.w = 1.0 / 64, .tension = &field});
      for (uint32_t e = 0; e < made.size(); ++e) {
        const Ends ends = ends_of(mesh, e, positions);
        ASSERT_LE(length(made[e] - ends.middle()), (tension_bound + 1e-12) * ends.size()) << seed;
      }
    }
  }
}

TEST(Tension, BothHalfEdgesGiveTheSameBits) {
  for (uint32_t seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    Mesh mesh = build_mesh(random_manifold(random));
    for (Tension tension : {Tension::soft, Tension::sharp}) {
      const TensionField field = tension_field(mesh, face_normals(mesh), tension);
      const auto before = new_vertices(mesh.topology, mesh.positions, {.w = 0.01F, .tension = &field});
      Mesh turned = mesh;
      for (uint32_t e = 0; e < mesh.topology.edge_count(); ++e)
        if (const uint32_t t = mesh.topology.twin[mesh.topology.half_edge[e]]; t != none)
          turned.topology.half_edge[e] = t;
      ASSERT_EQ(new_vertices(turned.topology, turned.positions, {.w = 0.01F, .tension = &field}), before) << seed;
    }
  }
}

TEST(Tension, SharpEdgesOfADrumBecomeACircle) {
  // The rim of a drum with 24 corners becomes a circle, not a polygon.
  const Mesh drum = build_mesh(square_ring(24, 0.6F, 1, 0.5F));
  const Mesh sharp = refine(drum, {.levels = 3, .tension = Tension::sharp, .shape = Shape::plain}).mesh;
  const Mesh soft = refine(drum, {.levels = 3, .tension = Tension::soft, .shape = Shape::plain}).mesh;
  const auto least_outer_radius = [](const Mesh& mesh) {
    double least = 2;
    for (Vec3f p : mesh.positions)
      if (p.z == 0 && std::hypot(p.x, p.y) > 0.975) least = std::min(least, double{std::hypot(p.x, p.y)});
    return least;
  };
  EXPECT_GT(least_outer_radius(sharp), 0.9995);
  EXPECT_LT(least_outer_radius(soft), least_outer_radius(sharp));
}

}  // namespace
}  // namespace papilio
