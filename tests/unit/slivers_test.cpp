#include "core/detail/slivers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "core/detail/seams.h"
#include "core/detail/surface_distance.h"
#include "papilio/refine.h"
#include "proto/detail/pack.h"
#include "tests/support/bumpy_sphere.h"
#include "tests/support/invariants.h"
#include "tests/support/shapes.h"

// Removal of slivers, as isosurfaces have them, before an original is simplified.

namespace papilio {
namespace {

uint32_t add_point(TriangleMesh& mesh, Vec3f place) {
  mesh.positions.push_back(place);
  return static_cast<uint32_t>(mesh.positions.size() - 1);
}

/// Inserts a tiny triangle at the first corner of every `period`-th face and a flat one at its opposite side.
TriangleMesh with_slivers(const TriangleMesh& mesh, uint32_t period, float size) {
  TriangleMesh made = mesh;
  made.triangles.clear();
  for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    if (f % period > 0) {
      made.triangles.push_back(mesh.triangles[f]);
      continue;
    }
    const auto [a, b, c] = mesh.triangles[f];
    const Vec3f at = mesh.positions[a];
    const Vec3f to_b = mesh.positions[b] - at, to_c = mesh.positions[c] - at;
    const uint32_t p = add_point(made, at + size * (to_b + to_c));
    const uint32_t q = add_point(made, at + size * (2 * to_b + to_c));
    const uint32_t r = add_point(made, at + size * (to_b + 2 * to_c));
    const uint32_t s = add_point(made, at + (0.4F - size) * to_b + 0.6F * to_c);
    for (const Triangle t :
         {Triangle{p, q, r}, {a, q, p}, {a, p, r}, {a, b, q}, {a, r, c}, {q, b, s}, {q, s, r}, {r, s, c}, {b, c, s}})
      made.triangles.push_back(t);
  }
  return made;
}

/// Returns the smallest edge length or height of all faces.
double least_size(const TriangleMesh& mesh) {
  double least = 1e9;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = to_double(mesh.positions[t[0]]), b = to_double(mesh.positions[t[1]]),
                c = to_double(mesh.positions[t[2]]);
    const double longest = std::max({length(b - a), length(c - b), length(a - c)});
    least = std::min(least, length(cross(b - a, c - a)) / longest);
  }
  return least;
}

TEST(Slivers, RegularMeshIsUnchanged) {
  for (const TriangleMesh& mesh : {test::bumpy_sphere(3), test::torus(60, 30), test::grid(9, 7)})
    EXPECT_EQ(remove_slivers(build_mesh(mesh), 1e-2).triangles(), build_mesh(mesh).triangles());
}

TEST(Slivers, SliversAreRemovedWithinTheDistance) {
  constexpr double distance = 1e-3;
  const TriangleMesh thin = with_slivers(test::bumpy_sphere(3), 7, 1e-4F);
  ASSERT_LT(least_size(thin), 1e-4);
  const Mesh made = remove_slivers(build_mesh(thin), distance);
  EXPECT_TRUE(test::is_consistent(made));
  EXPECT_EQ(made.topology.euler_characteristic(), 2);
  EXPECT_EQ(std::ranges::count(made.topology.kind, EdgeKind::boundary), 0);
  EXPECT_GT(least_size(made.triangles()), 1e-2);
  EXPECT_LE(vertex_distance(SurfaceTree(thin), SurfaceTree(made.triangles())), distance);
}

TEST(Slivers, SliversLargerThanTheDistanceAreKept) {
  const Mesh thin = build_mesh(with_slivers(test::bumpy_sphere(3), 7, 1e-3F));
  EXPECT_EQ(remove_slivers(thin, 1e-7).triangles(), thin.triangles());
}

TEST(Slivers, RemovalIsPolledAllAlongAndStops) {
  const Mesh thin = build_mesh(with_slivers(test::bumpy_sphere(4), 1, 1e-4F));
  ASSERT_GT(thin.topology.face_count(), 40'000U);
  int calls = 0;
  (void)remove_slivers(thin, 1e-3, Poller([&] { ++calls; }));
  EXPECT_GT(calls, 12);  // while faces are looked at, and while slivers are removed
  struct Stop {};
  for (int left = 0; left < calls; left += 3) {
    int until = left;
    const auto stop = [&] {
      if (until-- == 0) throw Stop();
    };
    EXPECT_THROW((void)remove_slivers(thin, 1e-3, Poller(stop)), Stop) << left;
  }
}

TEST(Slivers, SliversAtBoundariesAreRemoved) {
  TriangleMesh sheet = test::grid(4, 4);
  const auto [a, b, c] = sheet.triangles[0];
  for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) {
    // A flat face at each boundary side of the first face.
    const Vec3f middle = 0.5F * (sheet.positions[from] + sheet.positions[to]);
    if (middle.x > 0 && middle.y > 0) continue;
    const Vec3f out{middle.x > 0 ? 0 : -1e-5F, middle.y > 0 ? 0 : -1e-5F, 0};
    const uint32_t p = add_point(sheet, middle + out);
    sheet.triangles.push_back({to, from, p});
  }
  const Mesh made = remove_slivers(build_mesh(sheet), 1e-3);
  EXPECT_TRUE(test::is_consistent(made));
  EXPECT_EQ(made.topology.euler_characteristic(), 1);
}

TEST(Slivers, SeamsAreKept) {
  TriangleMesh sphere = with_slivers(test::bumpy_sphere(3), 5, 1e-4F);
  // Two charts with separate points where x changes its sign.
  Attribute chart{.components = 1, .values = {}};
  TriangleMesh charts{.positions = {}, .triangles = {}};
  std::array<std::vector<uint32_t>, 2> number;
  for (auto& of_chart : number) of_chart.assign(sphere.positions.size(), none);
  for (const Triangle& t : sphere.triangles) {
    const float x = sphere.positions[t[0]].x + sphere.positions[t[1]].x + sphere.positions[t[2]].x;
    const size_t side = x > 0 ? 1 : 0;
    Triangle made{};
    for (size_t i = 0; i < 3; ++i) {
      uint32_t& point = number[side][t[i]];
      if (point == none) {
        point = add_point(charts, sphere.positions[t[i]]);
        chart.values.push_back(static_cast<double>(side));
      }
      made[i] = point;
    }
    charts.triangles.push_back(made);
  }
  charts.attributes.push_back(chart);
  const Mesh made = remove_slivers(build_mesh(charts), 1e-3);
  EXPECT_TRUE(test::is_consistent(build_mesh(TriangleMesh{made.triangles().positions, made.triangles().triangles})));
  EXPECT_EQ(made.topology.euler_characteristic(), 2);
  EXPECT_LT(made.topology.face_count(), charts.triangles.size());
  const CutSurface cut = cut_at_seams(made, seam_edges(made));
  EXPECT_EQ(cut.topology.vertex_count - cut.topology.edge_count() + cut.topology.face_count(), 2U);  // two discs
  for (uint32_t h = 0; h < made.topology.half_edge_count(); ++h) {
    const auto value = [&](uint32_t at) { return made.attributes.attributes[0].values[made.attributes.point[at]]; };
    EXPECT_EQ(value(h), value(Topology::next(h)));
  }
}

/// Inserts a tiny triangle of any orientation into every `period`-th face.
TriangleMesh with_warts(const TriangleMesh& mesh, uint32_t period, double size) {
  TriangleMesh made = mesh;
  std::mt19937 random(1);
  std::normal_distribution<double> part;
  for (uint32_t f = 0; f < mesh.triangles.size(); f += period) {
    const auto [a, b, c] = mesh.triangles[f];
    const Vec3d centre =
        1 / 3.0 * (to_double(mesh.positions[a]) + to_double(mesh.positions[b]) + to_double(mesh.positions[c]));
    std::array<uint32_t, 3> inner{};
    for (uint32_t& v : inner)
      v = add_point(made, to_float(centre + size * Vec3d{part(random), part(random), part(random)}));
    const auto [p, q, r] = inner;
    made.triangles[f] = {p, q, r};
    for (const Triangle t : {Triangle{a, b, p}, {b, q, p}, {b, c, q}, {c, r, q}, {c, a, r}, {a, p, r}})
      made.triangles.push_back(t);
  }
  return made;
}

// As of scans whose cells pass through the surface close to their corners.
TEST(Pack, TinyFacesOfAnyOrientationCostLittle) {
  const TriangleMesh smooth = test::bumpy_sphere(4);
  const double wanted = 1e-3 * bounding_box(smooth.positions).diagonal();
  const auto packed = [](const TriangleMesh& original) { return proto::detail::pack(original, {.rms = 1e-3}); };
  const proto::detail::Packed warty = packed(with_warts(smooth, 5, 0.06 * wanted));
  ASSERT_TRUE(warty.model) << warty.reason;
  EXPECT_LE(proto::detail::reach_of(*warty.model).rms, 1e-3);
  EXPECT_LT(static_cast<double>(warty.glb.size()), 1.1 * static_cast<double>(packed(smooth).glb.size()));
}

TEST(Pack, OriginalWithSliversHasLevels) {
  const proto::detail::Packed packed =
      proto::detail::pack(with_slivers(test::bumpy_sphere(4), 5, 2e-6F), {.rms = 1e-3});
  ASSERT_TRUE(packed.model) << packed.reason;
  EXPECT_LT(4 * packed.glb.size(), packed.plain_bytes);
  EXPECT_LE(proto::detail::reach_of(*packed.model).rms, 1e-3);
}

}  // namespace
}  // namespace papilio
