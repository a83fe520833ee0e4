#include "core/rules/butterfly.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/mesh/fan.h"
#include "core/rules/stencil.h"
#include "tests/support/shapes.h"
#include "tests/support/whole_split.h"

namespace papilio {
namespace {

using namespace test;

uint32_t edge_between(const Mesh& mesh, Vec3f a, Vec3f b) {
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
    if (mesh.positions[mesh.topology.origin[h]] == a && mesh.positions[mesh.topology.tip(h)] == b)
      return mesh.topology.edge[h];
  ADD_FAILURE() << "no such edge";
  return 0;
}

void expect_near(Vec3d a, Vec3d b, double tolerance) { EXPECT_LE(length(a - b), tolerance); }

TEST(Butterfly, RegularEdgeFollowsTheEightPointRule) {
  Mesh mesh = build_mesh(grid(6, 6));
  for (size_t v = 0; v < mesh.positions.size(); ++v) mesh.positions[v].z = static_cast<float>((v * 7919) % 101);
  const auto z = [&](float x, float y) {
    for (Vec3f p : mesh.positions)
      if (p.x == x && p.y == y) return double{p.z};
    return std::nan("");
  };
  // From (3,3) to (4,3): apexes (4,4) and (3,2), wings across the four outer edges.
  const Buffer<Vec3d> all = new_vertices(mesh.topology, in_double(mesh));
  const uint32_t along = [&] {
    for (uint32_t e = 0; e < mesh.topology.edge_count(); ++e) {
      const Vec3f a = mesh.positions[mesh.topology.origin[mesh.topology.half_edge[e]]];
      const Vec3f b = mesh.positions[mesh.topology.tip(mesh.topology.half_edge[e])];
      if (std::min(a.x, b.x) == 3 && std::max(a.x, b.x) == 4 && a.y == 3 && b.y == 3) return e;
    }
    return none;
  }();
  ASSERT_NE(along, none);
  const double expected =
      0.5 * (z(3, 3) + z(4, 3)) + 0.125 * (z(4, 4) + z(3, 2)) - 0.0625 * (z(3, 4) + z(5, 4) + z(2, 2) + z(4, 2));
  EXPECT_NEAR(all[along].z, expected, 1e-12);
  const double w = 1.0 / 64;
  const double ten_points = (0.5 - w) * (z(3, 3) + z(4, 3)) + (0.125 + 2 * w) * (z(4, 4) + z(3, 2)) -
                            (0.0625 + w) * (z(3, 4) + z(5, 4) + z(2, 2) + z(4, 2)) + w * (z(2, 3) + z(5, 3));
  EXPECT_NEAR(new_vertices(mesh.topology, in_double(mesh), {.w = w})[along].z, ten_points, 1e-12);
}

TEST(Butterfly, PlanarMeshesOfAnyShapeStayPlanar) {
  for (uint32_t seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    Mesh mesh = build_mesh(random_manifold(random));
    for (Vec3f& p : mesh.positions) p.z = 0.25F * p.x - 0.5F * p.y + 3;
    for (Vec3d q : new_vertices(mesh.topology, in_double(mesh)))
      ASSERT_NEAR(q.z, 0.25 * q.x - 0.5 * q.y + 3, 1e-5) << seed;  // rounding of the positions
  }
}

TEST(Butterfly, LinearFunctionsOnRegularLayoutsAreReproduced) {
  const Mesh mesh = build_mesh(grid(5, 4));  // interior, boundary and corner stencils on a regular lattice
  const Buffer<Vec3d> q = new_vertices(mesh.topology, in_double(mesh));
  for (uint32_t e = 0; e < mesh.topology.edge_count(); ++e) {
    const uint32_t h = mesh.topology.half_edge[e];
    const Vec3d a = to_double(mesh.positions[mesh.topology.origin[h]]);
    const Vec3d b = to_double(mesh.positions[mesh.topology.tip(h)]);
    const bool corner = [&] {  // the two-triangle corner of the lattice is not a half disc
      for (Vec3d p : {a, b})
        if ((p.x == 0 || p.x == 5) && (p.y == 0 || p.y == 4)) return true;
      return false;
    }();
    if (!corner) expect_near(q[e], 0.5 * (a + b), 1e-12);
  }
}

TEST(Butterfly, BoundaryFollowsTheFourPointRule) {
  Mesh mesh = build_mesh(grid(6, 2));
  for (Vec3f& p : mesh.positions) p.z = p.y == 0 ? p.x * p.x : 100;  // only the rim contributes
  const Buffer<Vec3d> q = new_vertices(mesh.topology, in_double(mesh));
  const uint32_t inner = edge_between(mesh, {2, 0, 4}, {3, 0, 9});
  EXPECT_NEAR(q[inner].z, 9.0 / 16 * (4 + 9) - 1.0 / 16 * (1 + 16), 1e-12);
}

TEST(Butterfly, ExplicitWeightsAndHarmonicsAgree) {
  for (uint32_t k : {stencil::harmonic_valence, stencil::harmonic_valence + 7, 1000U}) {
    std::mt19937 random(k);
    Mesh mesh = build_mesh(bipyramid(k));
    std::uniform_real_distribution<float> jitter(-0.3F, 0.3F);
    for (Vec3f& p : mesh.positions) p += Vec3f{jitter(random), jitter(random), jitter(random)};
    const Buffer<Vec3d> q = new_vertices(mesh.topology, in_double(mesh));
    const stencil::Interior apex = stencil::interior(k);
    const stencil::Interior rim = stencil::interior(4);
    Fan fan;
    for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
      collect_fan(mesh.topology, h, fan);
      if (fan.valence() != k) continue;
      const auto contribution = [&](const Fan& f, const stencil::Interior& rule) {
        Vec3d sum = rule.centre * to_double(mesh.positions[f.centre]);
        for (uint32_t j = 0; j < f.valence(); ++j) sum += rule.ring[j] * to_double(mesh.positions[f.ring[j]]);
        return sum;
      };
      Fan other;
      collect_fan(mesh.topology, mesh.topology.twin[h], other);
      expect_near(q[mesh.topology.edge[h]], 0.5 * (contribution(fan, apex) + contribution(other, rim)), 1e-12);
    }
  }
}

TEST(Butterfly, ResultDoesNotDependOnTheOrderOfFaces) {
  for (uint32_t seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    TriangleMesh triangles = random_manifold(random);
    const auto vertices_of = [](const TriangleMesh& input) {
      Mesh mesh = build_mesh(input);
      const Buffer<Vec3f> made = new_vertices(mesh.topology, mesh.positions);
      mesh.positions.insert(mesh.positions.end(), made.begin(), made.end());
      std::sort(mesh.positions.begin(), mesh.positions.end(),
                [](Vec3f a, Vec3f b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
      return mesh.positions;
    };
    const Buffer<Vec3f> before = vertices_of(triangles);
    std::shuffle(triangles.triangles.begin(), triangles.triangles.end(), random);
    for (Triangle& t : triangles.triangles) std::rotate(t.begin(), t.begin() + 1, t.end());
    const Buffer<Vec3f> after = vertices_of(triangles);
    ASSERT_EQ(before.size(), after.size());
    // Above `harmonic_valence` the ring is summed from another start: equal up to rounding.
    for (size_t v = 0; v < before.size(); ++v)
      ASSERT_LE(length(to_double(before[v]) - to_double(after[v])), 4e-6) << seed;
  }
}

TEST(Butterfly, FansOfAPinchedVertexRefineSeparately) {
  // Two tetrahedra that touch at one vertex.
  const TriangleMesh one = tetrahedron();
  TriangleMesh two = join(one, one, 0);
  for (size_t v = 4; v < 8; ++v) two.positions[v] += Vec3f{2, 2, 2};
  two.positions[5] = two.positions[0];  // (-1,-1,1)+(2,2,2) = (1,1,3); welded to (1,1,1) instead
  const Mesh mesh = build_mesh(two);
  ASSERT_EQ(mesh.topology.vertex_count, 7U);
  const Buffer<Vec3f> together = new_vertices(mesh.topology, mesh.positions);
  TriangleMesh second = one;
  for (size_t v = 0; v < 4; ++v) second.positions[v] = two.positions[4 + v];
  Buffer<Vec3f> alone;
  for (const TriangleMesh& part : {one, second}) {
    const Mesh built = build_mesh(part);
    for (Vec3f q : new_vertices(built.topology, built.positions)) alone.push_back(q);
  }
  EXPECT_EQ(together, alone);
}

}  // namespace
}  // namespace papilio
