#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <span>
#include <string>
#include <tuple>

#include "core/detail/base_curves.h"
#include "core/detail/base_lift.h"
#include "core/detail/collapse_sequence.h"
#include "core/detail/detail_level.h"
#include "core/detail/linear_stencils.h"
#include "core/detail/manifold_surface.h"
#include "core/detail/original_curves.h"
#include "core/detail/sharp_curves.h"
#include "core/detail/surface_distance.h"
#include "core/mesh/crease.h"
#include "papilio/detail.h"
#include "papilio/error.h"
#include "tests/support/decoded_detail.h"
#include "tests/support/invariants.h"
#include "tests/support/sampled_distance.h"
#include "tests/support/shapes.h"

// Boundaries and creases of an original: detection, collapses and coding.

namespace papilio {
namespace {

constexpr double pi = std::numbers::pi;

/// A square sheet with waves.
TriangleMesh sheet(uint32_t n) {
  TriangleMesh made = test::grid(n, n);
  for (Vec3f& p : made.positions) {
    p = (1 / static_cast<float>(n)) * p;
    p.z = 0.1F * std::sin(5 * p.x) * std::cos(4 * p.y);
  }
  return made;
}

CodedBase unchanged_base(const TriangleMesh& base, std::span<const Vec3d> = {}) {
  return {base, 9 * base.positions.size()};
}

size_t count(const Topology& t, EdgeKind kind) { return static_cast<size_t>(std::ranges::count(t.kind, kind)); }

TEST(LinearStencils, StencilsEqualTheRulesAtCurves) {
  std::mt19937 random(1);
  size_t curves = 0;
  for (int round = 0; round < 150; ++round) {
    Mesh mesh = build_mesh(test::random_manifold(random));
    if (round % 3 > 0) mark_creases(mesh, round % 3 == 1 ? 25 : 5);
    Topology& t = mesh.topology;
    for (uint32_t v = 0; v < t.vertex_count && round % 2 == 0; ++v)
      if (random() % 10 == 0) t.shape.corners.push_back(v);
    curves += t.edge_count() - count(t, EdgeKind::smooth);
    DetailLevel level(t);
    Buffer<Vec3f> positions = mesh.positions;
    for (int l = 0; l < 2; ++l) {
      level.predict(positions);
      const LinearStencils stencils = linear_stencils(level.topology());
      ASSERT_EQ(stencils.first.size(), level.topology().edge_count() + 1);
      for (uint32_t e = 0; e < level.topology().edge_count(); ++e) {
        Vec3d sum;
        double weights = 0;
        for (uint32_t i = stencils.first[e]; i < stencils.first[e + 1]; ++i) {
          sum += double{stencils.weight[i]} * to_double(positions[stencils.vertex[i]]);
          weights += stencils.weight[i];
        }
        ASSERT_NEAR(weights, 1, 1e-6);
        ASSERT_LT(length(sum - to_double(positions[level.topology().vertex_count + e])), 1e-5) << round << ' ' << l;
      }
      level = level.next();
    }
  }
  EXPECT_GT(curves, 1000U);
}

// Explicit rules would have 4 million weights.
TEST(LinearStencils, VerticesOfManyFacesHaveFewWeights) {
  const Mesh tube = build_mesh(test::tube(1000, 4, 0.5F, true));
  const LinearStencils stencils = linear_stencils(tube.topology);
  EXPECT_LT(stencils.weight.size(), 16U * tube.topology.edge_count());
}

TEST(SharpCurves, BoxHasItsEdgesAndCorners) {
  Mesh mesh = build_mesh(test::box({6, 6, 6}, {1, 2, 3}));
  mark_sharp_curves(mesh);
  EXPECT_EQ(count(mesh.topology, EdgeKind::crease), 12U * 6);
  const std::vector<CurveRole> roles = curve_roles(mesh.topology);
  EXPECT_EQ(std::ranges::count(roles, CurveRole::corner), 8);
  EXPECT_EQ(std::ranges::count(roles, CurveRole::inner), 12 * 5);
}

TEST(SharpCurves, TubeWithLidsHasItsRims) {
  Mesh mesh = build_mesh(test::tube(48, 10, 2, true));
  mark_sharp_curves(mesh);
  EXPECT_EQ(count(mesh.topology, EdgeKind::crease), 2U * 48);
  EXPECT_TRUE(mesh.topology.shape.corners.empty());
}

TEST(SharpCurves, NoiseMakesNoCurves) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> noise(-0.03F, 0.03F);
  TriangleMesh rough = test::torus(80, 40);
  for (Vec3f& p : rough.positions) p = {p.x + noise(random), p.y + noise(random), p.z + noise(random)};
  Mesh mesh = build_mesh(rough);
  size_t sharp = 0;
  for (const uint32_t h : mesh.topology.half_edge) {
    const Vec3f* p = mesh.positions.data();
    const auto normal = [&](uint32_t side) {
      const uint32_t* v = &mesh.topology.origin[size_t{3} * Topology::face(side)];
      return cross(p[v[1]] - p[v[0]], p[v[2]] - p[v[0]]);
    };
    const Vec3f a = normal(h);
    const Vec3f b = normal(mesh.topology.twin[h]);
    sharp += dot(a, b) < std::cos(40 * pi / 180) * length(a) * length(b) ? 1 : 0;
  }
  ASSERT_GT(sharp, 500U) << "the noise makes sharp edges";
  mark_sharp_curves(mesh);
  EXPECT_EQ(count(mesh.topology, EdgeKind::crease), 0U);
}

TEST(SharpCurves, BoundaryOfASquareHasFourCorners) {
  Mesh mesh = build_mesh(sheet(10));
  mark_sharp_curves(mesh);
  EXPECT_EQ(count(mesh.topology, EdgeKind::crease), 0U);
  EXPECT_EQ(mesh.topology.shape.corners.size(), 4U);
}

TEST(OriginalCurves, MeetReturnsTheIntersectionWithAPlane) {
  Mesh mesh = build_mesh(test::tube(64, 8, 1, false));
  mark_sharp_curves(mesh);
  const OriginalCurves curves(mesh);
  const Nearest start = curves.nearest({2, 0, 0.1});
  EXPECT_NEAR(start.point.x, 1, 1e-6);
  EXPECT_NEAR(start.point.z, 0, 1e-6);
  const auto met = curves.meet(start.face, start.point, {0, 0.8, 0}, {0, 1, 0}, 2);
  ASSERT_TRUE(met);
  EXPECT_NEAR(met->y, 0.8, 1e-6);
  EXPECT_NEAR(met->x, 0.6, 2e-3);
  EXPECT_FALSE(curves.meet(start.face, start.point, {0, 0.8, 0}, {0, 1, 0}, 0.5)) << "too far along the curve";
  EXPECT_FALSE(curves.meet(start.face, start.point, {0, 1.5, 0}, {0, 1, 0}, 100)) << "the plane misses the circle";
}

TEST(ManifoldSurface, TouchingFansAreSeparated) {
  // Two tetrahedra that share an edge, and one that touches at a vertex.
  TriangleMesh touching = test::tetrahedron();
  const TriangleMesh other = test::tetrahedron();
  const Vec3f a = touching.positions[0];
  for (const Triangle& t : other.triangles) {
    Triangle moved;
    for (uint32_t i = 0; i < 3; ++i) {
      const Vec3f p = other.positions[t[i]];
      moved[i] = static_cast<uint32_t>(touching.positions.size());
      touching.positions.push_back(2.0F * a - p);
    }
    touching.triangles.push_back({moved[0], moved[2], moved[1]});
  }
  ASSERT_FALSE(build_mesh(touching).topology.pinched.empty());
  EXPECT_THROW(require_manifold(build_mesh(touching)), Error);
  const ManifoldSurface parted = manifold_surface(touching, 1e-3);
  EXPECT_EQ(parted.parted, 1U);
  EXPECT_EQ(parted.mesh.topology.vertex_count, 8U);
  EXPECT_EQ(parted.mesh.topology.euler_characteristic(), 4);
  size_t moved = 0;
  for (const Vec3f p : parted.mesh.positions) {
    float least = 1;
    for (const Vec3f q : touching.positions) least = std::min(least, length(p - q));
    EXPECT_LE(least, 1.001e-3F);
    moved += least > 0 ? 1 : 0;
  }
  EXPECT_EQ(moved, 1U);
}

TEST(ManifoldSurface, EdgesOfThreeFacesAreSeparated) {
  const TriangleMesh three{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 1}, {0, -1, -1}},
                           .triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
  const ManifoldSurface parted = manifold_surface(three, 0.01);
  EXPECT_EQ(parted.parted, 2U);
  EXPECT_EQ(parted.mesh.topology.face_count(), 3U);
  EXPECT_EQ(count(parted.mesh.topology, EdgeKind::boundary), 9U);
}

TEST(ManifoldSurface, FacesBackToBackAreSeparated) {
  // A two-sided leaf: its boundary edges have two faces, its diagonal four.
  const TriangleMesh leaf{.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.2F}, {0, 1, 0}},
                          .triangles = {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}, {3, 2, 0}}};
  const Mesh parted = manifold_surface(leaf, 0.01).mesh;
  EXPECT_EQ(parted.topology.face_count(), 4U);
  EXPECT_EQ(parted.topology.vertex_count, 12U);
  EXPECT_EQ(count(parted.topology, EdgeKind::boundary), 12U);
  for (const Vec3f p : parted.positions) {
    float least = 1;
    for (const Vec3f q : leaf.positions) least = std::min(least, length(p - q));
    EXPECT_LE(least, 0.0101F);
  }
}

class CurvedCollapses : public ::testing::TestWithParam<const char*> {
 protected:
  [[nodiscard]] static Mesh original() {
    const std::string name = GetParam();
    Mesh mesh = build_mesh(name == "tube"    ? test::tube(60, 20, 2, false)
                           : name == "can"   ? test::tube(60, 20, 2, true)
                           : name == "sheet" ? sheet(40)
                                             : test::box({10, 10, 10}, {1, 2, 3}));
    mark_sharp_curves(mesh);
    return mesh;
  }
};

TEST_P(CurvedCollapses, CollapsesKeepTopologyCurvesAndCorners) {
  const Mesh mesh = original();
  CollapseSequence sequence(mesh);
  for (const uint32_t faces : {400U, 100U, 40U, 0U}) {
    sequence.collapse_to(faces);
    const BaseMesh base = sequence.base();
    const Mesh coarse = build_mesh(base.triangles);
    EXPECT_TRUE(test::is_consistent(coarse));
    EXPECT_NO_THROW(require_manifold(coarse));
    EXPECT_EQ(coarse.topology.euler_characteristic(), mesh.topology.euler_characteristic());
    EXPECT_EQ(count(coarse.topology, EdgeKind::boundary) == 0, count(mesh.topology, EdgeKind::boundary) == 0);
    const std::vector<CurveRole> roles = curve_roles(mesh.topology);
    size_t corners = 0;
    for (uint32_t v = 0; v < base.vertex.size(); ++v) {
      EXPECT_EQ(base.triangles.positions[v], mesh.positions[base.vertex[v]]);
      EXPECT_EQ(base.is_corner[v], roles[base.vertex[v]] == CurveRole::corner);
      corners += base.is_corner[v] ? 1 : 0;
    }
    EXPECT_EQ(corners, static_cast<size_t>(std::ranges::count(roles, CurveRole::corner)));
    for (size_t f = 0; f < base.face.size(); ++f)
      for (size_t i = 0; i < 3; ++i) {
        if (!base.is_crease[f][i]) continue;
        for (const uint32_t v : {base.triangles.triangles[f][i], base.triangles.triangles[f][(i + 1) % 3]})
          EXPECT_NE(roles[base.vertex[v]], CurveRole::smooth);
      }
  }
}

TEST_P(CurvedCollapses, LiftMapsCurvesToCurvesAndCoversTheOriginal) {
  const OriginalSurface surface(original());
  CollapseSequence sequence(surface.mesh());
  sequence.collapse_to(120);
  const BaseMesh base = sequence.base();
  constexpr int levels = 4;
  const LiftedBase lifted = lift_base(sequence, base, {.triangles = base.triangles}, surface, levels, {});
  const auto same_share = [&](EdgeKind kind) {
    return (count(lifted.mesh.topology, kind) == 0) == (count(surface.mesh().topology, kind) == 0);
  };
  EXPECT_TRUE(same_share(EdgeKind::boundary));
  EXPECT_TRUE(same_share(EdgeKind::crease));
  DetailLevel level(lifted.mesh.topology);
  TriangleMesh made{.positions = lifted.mesh.positions, .triangles = {}};
  for (const auto& places : lifted.places) {
    for (const uint32_t e : level.curve_edges()) {
      const Vec3d point = to_double(places[e].point);
      EXPECT_LT(length(surface.curves().nearest(point).point - point), 1e-4);
    }
    for (const OriginalPlace& place : places) made.positions.push_back(place.point);
    level = level.next();
  }
  for (uint32_t h = 0; h < level.topology().half_edge_count(); h += 3)
    made.triangles.push_back(
        {level.topology().origin[h], level.topology().origin[h + 1], level.topology().origin[h + 2]});
  const SurfaceDistance distance = surface_distance(surface.tree(), SurfaceTree(made), 5000);
  EXPECT_LT(distance.rms, 0.01 * surface.diagonal());
  EXPECT_LT(distance.largest, 0.06 * surface.diagonal());
}

TEST_P(CurvedCollapses, BaseAndCurvesRoundTrip) {
  const OriginalSurface surface(original());
  CollapseSequence sequence(surface.mesh());
  sequence.collapse_to(100);
  const BaseMesh base = sequence.base();
  const LiftedBase lifted = lift_base(sequence, base, {.triangles = base.triangles}, surface, 1, {});
  const Topology& marked = lifted.mesh.topology;
  Topology plain = build_mesh(base.triangles).topology;
  decode_base_curves(encode_base_curves(marked), plain);
  EXPECT_EQ(plain.kind, marked.kind);
  EXPECT_EQ(plain.darts, marked.darts);
  EXPECT_EQ(plain.shape.corners, marked.shape.corners);
}

TEST_P(CurvedCollapses, EncodingHasTheStatedDistance) {
  const TriangleMesh triangles = original().triangles();
  DetailOptions options;
  options.rms = 2e-3;
  const EncodedDetail encoded = encode_detail(triangles, options, unchanged_base);
  EXPECT_LE(encoded.reach.back().rms, options.rms);
  const TriangleMesh decoded = test::decoded_triangles(encoded.base, encoded.levels);
  const test::SampledDistance distance = test::SampledSurface(triangles, 40'000).distance_to(decoded);
  EXPECT_LT(distance.rms / 100, 1.1 * options.rms);
  EXPECT_LT(distance.largest / 100, 1.5 * std::max(encoded.reach.back().largest, options.rms));
  const Mesh fine = build_mesh(decoded);
  EXPECT_NO_THROW(require_manifold(fine));
  EXPECT_EQ(fine.topology.euler_characteristic(), build_mesh(triangles).topology.euler_characteristic());
  EXPECT_LE(encoded.folds, decoded.triangles.size() / 200);
}

TEST_P(CurvedCollapses, BaseVerticesOnCurvesMustNotSlide) {
  const Mesh mesh = original();
  std::set<Vec3f, bool (*)(const Vec3f&, const Vec3f&)> on_curves(
      [](const Vec3f& a, const Vec3f& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
    if (mesh.topology.kind[mesh.topology.edge[h]] != EdgeKind::smooth)
      on_curves.insert({mesh.positions[mesh.topology.origin[h]], mesh.positions[mesh.topology.tip(h)]});
  uint32_t sliding = 0, fixed = 0;
  (void)encode_detail(mesh.triangles(), {.rms = 2e-3}, [&](const TriangleMesh& base, std::span<const Vec3d> normals) {
    for (size_t v = 0; v < base.positions.size(); ++v) {
      EXPECT_NEAR(length(normals[v]), on_curves.contains(base.positions[v]) ? 0 : 1, 1e-6) << v;
      ++(length(normals[v]) > 0 ? sliding : fixed);
    }
    return unchanged_base(base);
  });
  EXPECT_GT(fixed, 0U);
  EXPECT_TRUE(sliding > 0 || GetParam() == std::string("box"));
}

INSTANTIATE_TEST_SUITE_P(Shapes, CurvedCollapses, ::testing::Values("tube", "can", "sheet", "box"),
                         [](const auto& shape) { return std::string(shape.param); });

TEST(BaseCurves, BaseWithoutCurvesTakesNoBytes) {
  EXPECT_TRUE(encode_base_curves(build_mesh(test::icosahedron()).topology).empty());
  EXPECT_TRUE(encode_base_curves(build_mesh(test::fan(6, true)).topology).empty()) << "boundaries take no bytes";
}

TEST(BaseCurves, RandomMarksRoundTrip) {
  std::mt19937 random(5);
  for (int round = 0; round < 100; ++round) {
    Mesh mesh = build_mesh(test::random_manifold(random));
    const Topology plain = mesh.topology;
    Topology& t = mesh.topology;
    for (EdgeKind& kind : t.kind)
      if (kind == EdgeKind::smooth && random() % 3 == 0) kind = EdgeKind::crease;
    t.darts = find_darts(t);
    std::vector<uint32_t> degree(t.vertex_count, 0);
    for (uint32_t e = 0; e < t.edge_count(); ++e)
      if (t.kind[e] != EdgeKind::smooth) ++degree[t.origin[t.half_edge[e]]], ++degree[t.tip(t.half_edge[e])];
    for (uint32_t v = 0; v < t.vertex_count; ++v)
      if (degree[v] == 2 && random() % 4 == 0) t.shape.corners.push_back(v);
    Topology decoded = plain;
    decode_base_curves(encode_base_curves(t), decoded);
    ASSERT_EQ(decoded.kind, t.kind);
    ASSERT_EQ(decoded.shape.corners, t.shape.corners);
    ASSERT_EQ(decoded.darts, t.darts);
  }
}

}  // namespace
}  // namespace papilio
