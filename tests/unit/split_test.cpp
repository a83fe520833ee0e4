#include "core/split/split.h"

#include <gtest/gtest.h>

#include <bit>
#include <set>

#include "core/split/split_pattern.h"
#include "tests/support/invariants.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

Mesh split_at_midpoints(Mesh mesh, const Marks& marks) {
  for (uint32_t e = 0; e < marks.size(); ++e) {
    if (marks[e] == 0) continue;
    const uint32_t h = mesh.topology.half_edge[e];
    mesh.positions.push_back(0.5F * (mesh.positions[mesh.topology.origin[h]] + mesh.positions[mesh.topology.tip(h)]));
  }
  mesh.topology = split(mesh.topology, marks, mesh.positions, mesh.attributes);
  return mesh;
}

double area(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles().triangles) {
    const Vec3d a = to_double(mesh.positions[t[0]]);
    sum += cross(to_double(mesh.positions[t[1]]) - a, to_double(mesh.positions[t[2]]) - a).z / 2;
  }
  return sum;
}

TEST(SplitPattern, EveryPatternTilesItsTriangle) {
  const Mesh triangle = build_mesh({{{0, 0, 0}, {4, 0, 0}, {1, 3, 0}}, {{0, 1, 2}}});
  for (unsigned mask = 0; mask < 8; ++mask) {
    for (bool second : {false, true}) {
      const SplitPattern& pattern = split_pattern(mask, second);
      EXPECT_EQ(pattern.children, std::popcount(mask) + 1);
      std::set<uint8_t> used;
      double total = 0;
      for (unsigned c = 0; c < pattern.children; ++c) {
        const auto position = [&](uint8_t local) {
          const auto corner = [&](unsigned i) { return to_double(triangle.positions[i % 3]); };
          return local < 3 ? corner(local) : 0.5 * (corner(local - 3U) + corner(local - 2U));
        };
        const auto [i, j, k] = pattern.corner[c];
        used.insert({i, j, k});
        const double part = cross(position(j) - position(i), position(k) - position(i)).z / 2;
        EXPECT_GT(part, 0) << mask;  // orientation is kept; no overlap, since the areas add up
        total += part;
      }
      EXPECT_DOUBLE_EQ(total, area(triangle)) << mask;
      EXPECT_EQ(used.size(), 3U + static_cast<unsigned>(std::popcount(mask)));
    }
  }
}

TEST(Split, AllEdgesGiveFourTimesTheFaces) {
  Mesh mesh = build_mesh(icosahedron());
  for (uint32_t level = 1; level <= 4; ++level) {
    const Marks all(mesh.topology.edge_count(), 1);
    mesh = split_at_midpoints(std::move(mesh), all);
    ASSERT_EQ(mesh.topology.face_count(), 20U << (2 * level));
    ASSERT_EQ(mesh.topology.edge_count(), 30U << (2 * level));
    ASSERT_TRUE(is_consistent(mesh));
  }
}

TEST(Split, RandomTargetsKeepEveryInvariant) {
  for (uint32_t seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    Mesh mesh = build_mesh(random_manifold(random));
    const int64_t euler = mesh.topology.euler_characteristic();
    for (int level = 0; level < 3; ++level) {
      Marks marks(mesh.topology.edge_count());
      const uint32_t density = 1 + random() % 4;
      for (uint8_t& mark : marks) mark = random() % 4 < density ? 1 : 0;
      const uint64_t expected = count_children(mesh.topology, marks);
      mesh = split_at_midpoints(std::move(mesh), marks);
      ASSERT_EQ(mesh.topology.face_count(), expected);
      ASSERT_TRUE(is_consistent(mesh)) << "seed " << seed << " level " << level;
      ASSERT_EQ(mesh.topology.euler_characteristic(), euler) << seed;
    }
  }
}

TEST(Split, SharedEdgesStayShared) {
  Mesh book =
      build_mesh({{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}}});
  for (int level = 0; level < 3; ++level) {
    const Marks all(book.topology.edge_count(), 1);
    book = split_at_midpoints(std::move(book), all);
    ASSERT_TRUE(is_consistent(book));
  }
  EXPECT_EQ(count_edges(book.triangles()).irregular, 8U);
}

TEST(Split, TwoTargetsAreCutAlongTheShorterDiagonal) {
  // Edges 0-1 and 1-2 are targets. The diagonals run from vertex 0 to the midpoint of 1-2 and from vertex 2 to the
  // midpoint of 0-1.
  const auto far_corner = [](Vec3f two) {
    Mesh mesh = build_mesh({{{0, 0, 0}, {4, 0, 0}, two}, {{0, 1, 2}}});
    Marks marks(3, 0);
    marks[mesh.topology.edge[0]] = marks[mesh.topology.edge[1]] = 1;
    mesh = split_at_midpoints(std::move(mesh), marks);
    std::array<int, 3> uses{};
    for (uint32_t v : mesh.topology.origin)
      if (v < 3) ++uses[v];
    return uses[0] == 2 ? 0 : 2;  // the coarse vertex at the diagonal is in two children
  };
  EXPECT_EQ(far_corner({0, 3, 0}), 0);   // squared lengths: 6.25 from vertex 0, 13 from vertex 2
  EXPECT_EQ(far_corner({2, 1, 0}), 2);   // 9.25 and 1
  EXPECT_EQ(far_corner({-2, 2, 0}), 0);  // 2 and 20
  EXPECT_EQ(far_corner({4, 4, 0}), 0);   // 20 and 20: the lower vertex
}

}  // namespace
}  // namespace papilio
