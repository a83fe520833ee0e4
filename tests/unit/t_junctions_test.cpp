#include "core/mesh/t_junctions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "papilio/refine.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

constexpr double third_part = 1.0 / 3;

uint32_t defects(const BuildReport& found) {
  return found.non_manifold_edges + found.misoriented_edges + found.pinched_vertices;
}

double area_of(const Mesh& mesh) {
  double area = 0;
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); h += 3) {
    const auto at = [&](uint32_t k) { return to_double(mesh.positions[mesh.topology.origin[k]]); };
    area += length(cross(at(h + 1) - at(h), at(h + 2) - at(h))) / 2;
  }
  return area;
}

/// A square below the x axis, and above it `parts` strips whose corners lie on the square's upper side.
TriangleMesh wall(uint32_t parts) {
  TriangleMesh mesh{{{0, -1, 0}, {1, -1, 0}, {1, 0, 0}, {0, 0, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  for (uint32_t i = 0; i <= parts; ++i)
    for (const float y : {0.F, 1.F})
      mesh.positions.push_back({static_cast<float>(i) / static_cast<float>(parts), y, 0});
  for (uint32_t i = 0; i < parts; ++i) {
    const uint32_t first = 4 + 2 * i;
    mesh.triangles.push_back({first, first + 2, first + 3});
    mesh.triangles.push_back({first, first + 3, first + 1});
  }
  return mesh;
}

TEST(TJunctions, VerticesOnASideAreInserted) {
  for (const uint32_t parts : {2, 3, 10, 100}) {
    BuildReport open, found;
    const Mesh before = build_mesh(wall(parts), &open);
    const Mesh mesh = build_mesh(wall(parts), &found, rounding_gap);
    EXPECT_EQ(found.t_junctions, parts - 1);
    EXPECT_EQ(found.near_duplicates, 0U);
    EXPECT_EQ(found.boundary_edges, 3 + 2 + parts);
    EXPECT_EQ(defects(found), 0U);
    EXPECT_EQ(open.t_junctions, 0U);
    EXPECT_EQ(mesh.topology.face_count(), 2 + 2 * parts + parts - 1);
    EXPECT_EQ(mesh.topology.vertex_count, before.topology.vertex_count);
    EXPECT_EQ(mesh.topology.euler_characteristic(), 1);
    EXPECT_NEAR(area_of(mesh), 2, 1e-9);
  }
}

TEST(TJunctions, RefinementHasNoCrack) {
  const Result result = refine(build_mesh(wall(3), nullptr, rounding_gap), {.levels = 3, .edges = true});
  uint32_t boundary = 0;
  for (const EdgeKind kind : result.mesh.topology.kind) boundary += kind == EdgeKind::boundary ? 1 : 0;
  EXPECT_EQ(boundary, 8 * (3 + 2 + 3));
  EXPECT_EQ(result.mesh.topology.euler_characteristic(), 1);
}

TEST(TJunctions, VerticesOnAllThreeSidesAreInserted) {
  // A large triangle among smaller ones along its sides.
  TriangleMesh mesh{{{0, 0, 0}, {6, 0, 0}, {0, 6, 0}}, {{0, 1, 2}}};
  const auto flap = [&](Vec3f a, Vec3f b, Vec3f out) {  // three faces along the side from b to a
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const Vec3f p :
         {a, a + static_cast<float>(third_part) * (b - a), a + static_cast<float>(2 * third_part) * (b - a), b, out})
      mesh.positions.push_back(p);
    for (uint32_t i = 0; i < 3; ++i) mesh.triangles.push_back({first + i + 1, first + i, first + 4});
  };
  flap({0, 0, 0}, {6, 0, 0}, {3, -2, 0});
  flap({6, 0, 0}, {0, 6, 0}, {5, 5, 0});
  flap({0, 6, 0}, {0, 0, 0}, {-2, 3, 0});
  BuildReport found;
  const Mesh built = build_mesh(mesh, &found, rounding_gap);
  EXPECT_EQ(found.t_junctions, 6U);
  EXPECT_EQ(built.topology.face_count(), 9U + 7U);
  EXPECT_EQ(found.boundary_edges, 6U);
  EXPECT_EQ(defects(found), 0U);
  EXPECT_EQ(built.topology.euler_characteristic(), 1);
}

TEST(TJunctions, EndsWithinRoundingAreJoined) {
  TriangleMesh mesh = wall(3);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> noise(-2e-7F, 2e-7F);
  for (uint32_t p = 4; p < mesh.positions.size(); ++p)
    mesh.positions[p] += Vec3f{noise(random), noise(random), noise(random)};
  BuildReport found;
  const Mesh built = build_mesh(mesh, &found, rounding_gap);
  EXPECT_EQ(found.t_junctions, 2U);
  EXPECT_EQ(found.near_duplicates, 2U);
  EXPECT_EQ(found.boundary_edges, 3U + 2U + 3U);
  EXPECT_EQ(built.topology.euler_characteristic(), 1);
}

TEST(TJunctions, BoundariesThatOnlyTouchAreUnchanged) {
  // A triangle whose tip touches the side of a square from outside.
  TriangleMesh mesh = wall(1);
  mesh.triangles.resize(2);
  for (const Vec3f p : {Vec3f{0.5F, 0, 0}, {0.8F, 1, 0}, {0.2F, 1, 0}}) mesh.positions.push_back(p);
  const auto last = static_cast<uint32_t>(mesh.positions.size());
  mesh.triangles.push_back({last - 3, last - 2, last - 1});
  BuildReport found;
  EXPECT_EQ(build_mesh(mesh, &found, rounding_gap).topology.face_count(), 3U);
  EXPECT_EQ(found.t_junctions, 0U);
  EXPECT_EQ(defects(found), 0U);
}

TEST(TJunctions, BoundariesOfEqualDirectionAreUnchanged) {
  TriangleMesh mesh = wall(2);
  for (size_t t = 2; t < mesh.triangles.size(); ++t) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  BuildReport found;
  EXPECT_EQ(build_mesh(mesh, &found, rounding_gap).topology.face_count(), 6U);
  EXPECT_EQ(found.t_junctions, 0U);
}

TEST(TJunctions, FacesThinnerThanTheGapAreNotDivided) {
  TriangleMesh mesh = wall(2);
  mesh.positions[0].y = mesh.positions[1].y = -1e-7F;  // the square is a sliver
  BuildReport exact, found;
  (void)build_mesh(mesh, &exact);
  const Mesh built = build_mesh(mesh, &found, rounding_gap);
  EXPECT_LE(defects(found), defects(exact));
  for (uint32_t h = 0; h < built.topology.half_edge_count(); h += 3) {
    const auto at = [&](uint32_t k) { return to_double(built.positions[built.topology.origin[k]]); };
    EXPECT_GT(cross(at(h + 1) - at(h), at(h + 2) - at(h)).z, 0);
  }
}

TEST(TJunctions, InsertedPointsHaveTheDividedFacesChart) {
  TriangleMesh mesh = wall(2);
  Attribute texture{.components = 2, .values = {}};
  for (size_t p = 0; p < mesh.positions.size(); ++p) {
    const Vec3f at = mesh.positions[p];
    const double shift = p < 4 ? 0 : 10;  // the strips are in another chart
    texture.values.insert(texture.values.end(), {at.x + shift, at.y});
  }
  mesh.attributes.push_back(texture);
  const Mesh built = build_mesh(mesh, nullptr, rounding_gap);
  uint32_t in_the_middle = 0;
  for (uint32_t h = 0; h < built.topology.half_edge_count(); ++h) {
    const Vec3f at = built.positions[built.topology.origin[h]];
    const double u = built.attributes.attributes[0].values[2 * built.attributes.point[h]];
    const bool is_below = Topology::face(h) < 3;
    EXPECT_DOUBLE_EQ(u, at.x + (is_below ? 0 : 10));
    if (is_below && at == Vec3f{0.5F, 0, 0}) ++in_the_middle;
  }
  EXPECT_EQ(in_the_middle, 2U);
  EXPECT_EQ(built.attributes.point_count, 4U + 6U + 1U);
  for (double& value : mesh.attributes[0].values) value = value >= 9 ? value - 10 : value;  // one chart
  EXPECT_EQ(build_mesh(mesh, nullptr, rounding_gap).attributes.point_count, 8U);
}

TEST(TJunctions, MeshesWithoutTJunctionsAreUnchanged) {
  for (const TriangleMesh& shape :
       {grid(6, 5), fan(7, false), square_ring(24, 0.6F, 1, 0.5F), join(grid(2, 2), grid(2, 2), 9)}) {
    BuildReport found;
    const Mesh one = build_mesh(shape), other = build_mesh(shape, &found, rounding_gap);
    EXPECT_EQ(one.topology.origin, other.topology.origin);
    EXPECT_EQ(one.positions, other.positions);
    EXPECT_EQ(found.t_junctions, 0U);
  }
}

TEST(TJunctions, CrowdedLinesTakeBoundedWork) {
  // Faces with one side on a common line; most sides contain thousands of other faces' corners.
  std::mt19937 random(1);
  TriangleMesh mesh;
  for (uint32_t i = 0; i < 20'000; ++i) {
    const auto a = static_cast<float>(random() % 65'536), b = static_cast<float>(random() % 65'536);
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const Vec3f p : {Vec3f{a, 0, 0}, {b, 0, 0}, {a, static_cast<float>(i % 100), static_cast<float>(i)}})
      mesh.positions.push_back(p);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  BuildReport exact, found;
  (void)build_mesh(mesh, &exact);
  const Mesh built = build_mesh(mesh, &found, rounding_gap);
  EXPECT_LE(defects(found), defects(exact));
  EXPECT_LE(built.topology.face_count(), 4 * mesh.triangles.size());
}

TEST(TJunctions, RandomSurfacesNeverGainDefects) {
  std::mt19937 random(11);
  const auto below = [&](uint32_t end) { return static_cast<uint32_t>(random() % end); };
  uint32_t inserted = 0;
  for (int i = 0; i < 400; ++i) {
    TriangleMesh mesh;
    for (uint32_t p = 0; p < 30; ++p)
      mesh.positions.push_back(
          {static_cast<float>(below(5)), static_cast<float>(below(5)), static_cast<float>(below(2))});
    while (mesh.triangles.size() < 25) mesh.triangles.push_back({below(30), below(30), below(30)});
    BuildReport exact, found;
    const Mesh before = build_mesh(mesh, &exact);
    const Mesh after = build_mesh(mesh, &found, rounding_gap);
    EXPECT_LE(found.non_manifold_edges, exact.non_manifold_edges);
    EXPECT_LE(found.misoriented_edges, exact.misoriented_edges);
    EXPECT_LE(found.pinched_vertices, exact.pinched_vertices);
    EXPECT_EQ(after.topology.face_count(), before.topology.face_count() + found.t_junctions);
    EXPECT_NEAR(area_of(after), area_of(before), 1e-4);
    inserted += found.t_junctions;
  }
  EXPECT_GT(inserted, 0U);
}

}  // namespace
}  // namespace papilio
