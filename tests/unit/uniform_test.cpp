#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>

#include "core/butterfly.h"
#include "core/crease.h"
#include "core/features.h"
#include "core/normals.h"
#include "core/split.h"
#include "core/split_in_four.h"
#include "core/tension.h"
#include "tests/support/shapes.h"
#include "tests/support/whole_split.h"

// Uniform levels are made by formula, face by face; the same levels made edge by edge, by a plan that splits
// everything, must be the same to the bit.

namespace papilio {
namespace {

using namespace test;

/// Three sheets that meet in one line, and two that touch in one point.
TriangleMesh shared_and_pinched() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5F}, {-1, 1, 0.5F}, {-1, -1, 0.5F},
                    {3, 0, 0}, {3, 1, 0}, {4, 0, 1},    {2, 0, 1},     {2, 1, 2}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {5, 6, 7}, {5, 8, 9}, {2, 1, 7}};
  return mesh;
}

/// Many shapes, their vertices shaken so that no two weights may be mixed up unseen.
std::vector<Mesh> shaken_meshes() {
  std::vector<TriangleMesh> shapes{tetrahedron(),
                                   icosahedron(),
                                   cube(),
                                   torus(7, 5),
                                   grid(4, 3),
                                   square_ring(4, 1, 2, 0.5F),
                                   fan(40, true),
                                   fan(5, false),
                                   bipyramid(50),
                                   shared_and_pinched(),
                                   bipyramid(3),
                                   join(cube(), grid(2, 2), 5),
                                   box({3, 2, 1}, {3, 2, 1})};
  std::mt19937 random(7);
  for (int i = 0; i < 40; ++i) shapes.push_back(random_manifold(random));
  std::uniform_real_distribution<float> shake(-0.1F, 0.1F);
  std::vector<Mesh> meshes;
  for (TriangleMesh& shape : shapes) {
    for (Vec3f& p : shape.positions) p += Vec3f{shake(random), shake(random), shake(random)};
    meshes.push_back(build_mesh(shape));
    Mesh creased = meshes.back();
    mark_creases(creased, 40);
    meshes.push_back(creased);
  }
  return meshes;
}

void expect_same(const Topology& one, const Topology& other) {
  EXPECT_EQ(one.vertex_count, other.vertex_count);
  EXPECT_EQ(one.origin, other.origin);
  EXPECT_EQ(one.twin, other.twin);
  EXPECT_EQ(one.edge, other.edge);
  EXPECT_EQ(one.kind, other.kind);
  EXPECT_EQ(one.pinched, other.pinched);
  EXPECT_EQ(one.darts, other.darts);
  for (uint32_t e = 0; e < one.edge_count(); ++e) ASSERT_EQ(one.edge[one.half_edge[e]], e);
}

TEST(SplitInFour, IsTheSplitOfEverything) {
  for (Mesh& mesh : shaken_meshes())
    for (int level = 0; level < 3; ++level) {
      const SplitPlan plan = everything(mesh);
      Array<Vec3f> positions = mesh.positions;
      positions.resize(positions.size() + plan.count(), Vec3f{});
      const Topology expected = split(mesh.topology, plan, positions, mesh.attributes);
      const Topology made = split_in_four(mesh.topology);
      expect_same(made, expected);
      const Topology last = split_last_in_four(mesh.topology);
      EXPECT_FALSE(last.has_edges());
      EXPECT_EQ(last.origin, expected.origin);
      EXPECT_EQ(last.twin, expected.twin);
      mesh.topology = made;
      mesh.positions = positions;
    }
}

TEST(SplitInFour, HalvesLieAtTheirEnds) {
  const Mesh mesh = build_mesh(torus(5, 4));
  const Topology finer = split_in_four(mesh.topology);
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
    const uint32_t middle = mesh.topology.vertex_count + mesh.topology.edge[h];
    EXPECT_EQ(finer.origin[first_half(h)], mesh.topology.origin[h]);
    EXPECT_EQ(finer.tip(first_half(h)), middle);
    EXPECT_EQ(finer.origin[second_half(h)], middle);
    EXPECT_EQ(finer.tip(second_half(h)), mesh.topology.tip(h));
  }
}

TEST(Features, DescendAsTheyWouldBeFound) {
  for (Mesh& mesh : shaken_meshes()) {
    Features features = find_features(mesh.topology);
    for (int level = 1; level <= 3; ++level) {
      descend(features, mesh.topology);
      mesh.topology = split_in_four(mesh.topology);
      Features found = find_features(mesh.topology);
      EXPECT_EQ(features.level, level);
      EXPECT_EQ(features.spokes, found.spokes);
      EXPECT_EQ(features.first_spoke, found.first_spoke);
      EXPECT_EQ(features.is_closed, found.is_closed);
      EXPECT_EQ(features.centre, found.centre);
      std::ranges::sort(features.curve_half_edges);
      EXPECT_EQ(features.curve_half_edges, found.curve_half_edges);
    }
  }
}

TEST(UniformButterfly, HasTheBitsOfTheRulesEdgeByEdge) {
  for (Mesh& mesh : shaken_meshes())
    for (const Tension tension : {Tension::off, Tension::soft, Tension::sharp}) {
      Mesh level = mesh;
      Features features = find_features(level.topology);
      for (int k = 0; k < 3; ++k) {
        std::optional<TensionField> field;
        if (tension != Tension::off) field = tension_field(level.topology, face_normals(level), tension);
        const TensionField* const used = field ? &*field : nullptr;
        const Array<Vec3f> expected = butterfly(level.topology, level.positions, everything(level), 0.0F, used);
        const uint32_t vertices = level.topology.vertex_count;
        level.positions.resize(vertices + expected.size());
        uniform_butterfly(level.topology, features, level.positions.data(), &level.positions[vertices], used);
        for (size_t e = 0; e < expected.size(); ++e)
          ASSERT_EQ(level.positions[vertices + e], expected[e]) << "level " << k << ", edge " << e;
        descend(features, level.topology);
        level.topology = split_in_four(level.topology);
      }
    }
}

}  // namespace
}  // namespace papilio
