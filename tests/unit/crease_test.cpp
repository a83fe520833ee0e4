#include "core/mesh/crease.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/mesh/fan.h"
#include "papilio/refine.h"
#include "tests/support/invariants.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

uint32_t count_creases(const Mesh& mesh) {
  return static_cast<uint32_t>(std::ranges::count(mesh.topology.kind, EdgeKind::crease));
}

Mesh with_creases(const TriangleMesh& triangles, double degrees) {
  Mesh mesh = build_mesh(triangles);
  mark_creases(mesh, degrees);
  return mesh;
}

TEST(Crease, EdgesSharperThanTheAngleAreCreases) {
  EXPECT_EQ(count_creases(with_creases(cube(), 60)), 12U);
  EXPECT_EQ(count_creases(with_creases(cube(), 89.9)), 12U);
  EXPECT_EQ(count_creases(with_creases(cube(), 90.1)), 0U);
  EXPECT_EQ(count_creases(with_creases(cube(), 180)), 0U);
  EXPECT_EQ(count_creases(with_creases(icosahedron(), 41.7)), 30U);  // its exterior angles are 41.8 degrees
  EXPECT_EQ(count_creases(with_creases(icosahedron(), 41.9)), 0U);
}

TEST(Crease, CubeStaysACube) {
  for (Scheme scheme : {Scheme::red_green, Scheme::in_place}) {
    for (Tension tension : {Tension::off, Tension::soft, Tension::sharp}) {
      const Mesh fine =
          refine(build_mesh(cube()), {.levels = 3, .scheme = scheme, .tension = tension, .crease_angle = 60}).mesh;
      EXPECT_EQ(fine.topology.face_count(), 12U * 64);
      EXPECT_EQ(count_creases(fine), 12U * 8);
      for (Vec3f p : fine.positions) {
        const double to_a_side = std::min(
            {std::abs(p.x), std::abs(p.y), std::abs(p.z), std::abs(1 - p.x), std::abs(1 - p.y), std::abs(1 - p.z)});
        ASSERT_LE(to_a_side, 1e-6);
        ASSERT_TRUE(p.x >= -1e-6 && p.y >= -1e-6 && p.z >= -1e-6 && p.x <= 1 + 1e-6 && p.y <= 1 + 1e-6);
      }
    }
  }
}

TEST(Crease, CornersOfThreeCreasesDoNotMove) {
  const Mesh coarse = build_mesh(cube());
  const Mesh fine = refine(coarse, {.levels = 4, .crease_angle = 60}).mesh;
  EXPECT_TRUE(std::equal(coarse.positions.begin(), coarse.positions.end(), fine.positions.begin()));
  // Each crease is straight up to its corner, where the curve ends.
  for (uint32_t h = 0; h < fine.topology.half_edge_count(); ++h) {
    if (fine.topology.kind[fine.topology.edge[h]] != EdgeKind::crease) continue;
    const Vec3f u = fine.positions[fine.topology.tip(h)] - fine.positions[fine.topology.origin[h]];
    const int directions = (std::abs(u.x) > 1e-6F) + (std::abs(u.y) > 1e-6F) + (std::abs(u.z) > 1e-6F);
    ASSERT_EQ(directions, 1);
  }
}

TEST(Crease, RimStaysPlanarAndRound) {
  const Mesh fine =
      refine(build_mesh(square_ring(24, 0.6F, 1, 0.5F)), {.levels = 3, .tension = Tension::off, .crease_angle = 60})
          .mesh;
  uint32_t seen = 0;
  for (uint32_t e = 0; e < fine.topology.edge_count(); ++e) {
    if (fine.topology.kind[e] != EdgeKind::crease) continue;
    const Vec3f p = fine.positions[fine.topology.origin[fine.topology.half_edge[e]]];
    const double radius = std::hypot(p.x, p.y);
    ASSERT_TRUE(std::abs(p.z) < 1e-6 || std::abs(p.z - 0.5) < 1e-6);
    ASSERT_LE(std::min(std::abs(radius - 1), std::abs(radius - 0.6)), 1e-3);
    ++seen;
  }
  EXPECT_EQ(seen, 4U * 24 * 8);
}

/// A plane with a crease that ends inside it: the half beyond x = 2 is folded up along y = 3, flattening out at x = 4.
TriangleMesh folded_sheet() {
  TriangleMesh sheet = grid(6, 6);
  for (Vec3f& p : sheet.positions)
    if (p.y > 3) p.z = (p.y - 3) * std::max(0.0F, 4 - p.x) * 0.5F;
  return sheet;
}

TEST(Crease, AdaptiveResultsAtDartsAreConsistentAndFinite) {
  Mesh mesh = build_mesh(folded_sheet());
  mark_creases(mesh, 40);
  ASSERT_GT(count_creases(mesh), 0U);
  ASSERT_FALSE(mesh.topology.darts.empty());
  for (Scheme scheme : {Scheme::red_green, Scheme::in_place}) {
    const Result result =
        refine(build_mesh(folded_sheet()), {.levels = 3, .scheme = scheme, .flatness = {0.999}, .crease_angle = 40});
    EXPECT_TRUE(is_consistent(result.mesh));
    for (Vec3f p : result.mesh.positions) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
  }
}

TEST(Crease, DartReproducesLinearFunctions) {
  // A flat sheet with creases marked by hand: all vertices stay at the grid's positions.
  Mesh mesh = build_mesh(grid(6, 6));
  const auto make_crease = [&](Vec3f a, Vec3f b) {
    for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
      if (mesh.positions[mesh.topology.origin[h]] == a && mesh.positions[mesh.topology.tip(h)] == b)
        mesh.topology.kind[mesh.topology.edge[h]] = EdgeKind::crease;
  };
  make_crease({1, 3, 0}, {2, 3, 0});
  make_crease({2, 3, 0}, {3, 3, 0});
  for (uint32_t v = 0; v < mesh.positions.size(); ++v)
    if (mesh.positions[v] == Vec3f{1, 3, 0} || mesh.positions[v] == Vec3f{3, 3, 0}) mesh.topology.darts.push_back(v);
  ASSERT_EQ(mesh.topology.darts.size(), 2U);
  const Mesh fine = refine(mesh, {.levels = 1, .tension = Tension::off}).mesh;
  ASSERT_EQ(count_creases(fine), 4U);
  const auto inside = [](Vec3f p) { return std::min(p.x, p.y) > 0 && std::max(p.x, p.y) < 6; };
  for (uint32_t e = 0; e < mesh.topology.edge_count(); ++e) {
    const uint32_t h = mesh.topology.half_edge[e];
    if (!inside(mesh.positions[mesh.topology.origin[h]]) || !inside(mesh.positions[mesh.topology.tip(h)])) continue;
    const Vec3f middle = 0.5F * (mesh.positions[mesh.topology.origin[h]] + mesh.positions[mesh.topology.tip(h)]);
    ASSERT_LE(length(fine.positions[mesh.topology.vertex_count + e] - middle), 1e-6F) << e;
  }
}

TEST(Crease, FlatSheetHasNoCreasesAtAnyAngle) {
  TriangleMesh sheet = grid(20, 20);
  for (Vec3f& p : sheet.positions) {  // rotated and scaled, so that normals round differently
    const float x = 0.137F * p.x;
    const float y = 0.291F * p.y;
    p = {0.6F * x - 0.3F * y, 0.5F * x + 0.7F * y, 0.2F * x + 0.55F * y};
  }
  EXPECT_EQ(count_creases(with_creases(sheet, 0)), 0U);
}

TEST(Crease, FanOfADartEndsWhereFacesAreMissing) {
  // Six of twelve faces are present, as at the border of a red-green level: the fan is open.
  Mesh mesh = build_mesh(fan(6, false));
  Topology& topology = mesh.topology;
  for (uint32_t h = 0; h < topology.half_edge_count(); ++h) {
    if (topology.origin[h] != 0 && topology.tip(h) != 0) continue;
    if (topology.twin[h] == none) topology.kind[topology.edge[h]] = EdgeKind::cut;
    if (topology.origin[h] == 0 && topology.tip(h) == 4) topology.kind[topology.edge[h]] = EdgeKind::crease;
  }
  topology.darts = {0};
  for (uint32_t h = 0; h < topology.half_edge_count(); ++h) {
    if (topology.origin[h] != 0) continue;
    Fan found;
    collect_fan(topology, h, found);
    EXPECT_FALSE(found.closed);
    EXPECT_EQ(found.valence(), 6U);
    EXPECT_EQ(found.ring.size(), 7U);
  }
}

TEST(Crease, RealMechanicalPartKeepsItsEdges) {
  const Mesh coarse = with_creases(real_mesh("cgal/rotor_small.off"), 50);
  ASSERT_GT(count_creases(coarse), 100U);
  for (Scheme scheme : {Scheme::red_green, Scheme::in_place}) {
    const Result result = refine(build_mesh(real_mesh("cgal/rotor_small.off")),
                                 {.levels = 2, .scheme = scheme, .crease_angle = 50, .tolerance = 1e-3});
    EXPECT_TRUE(is_consistent(result.mesh));
    EXPECT_EQ(result.mesh.topology.euler_characteristic(), coarse.topology.euler_characteristic());
    EXPECT_GE(count_creases(result.mesh), count_creases(coarse));
  }
}

}  // namespace
}  // namespace papilio
