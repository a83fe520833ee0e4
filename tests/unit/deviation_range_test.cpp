#include "core/criteria/deviation_range.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "core/criteria/deviation.h"
#include "core/mesh/normals.h"
#include "core/rules/butterfly.h"
#include "papilio/refine.h"
#include "tests/support/shapes.h"

// Ranges against the deviations themselves, for good faces and the worst.

namespace papilio {
namespace {

/// A mesh whose edges all are tried, with their new vertices.
struct Tried {
  Mesh mesh;
  Buffer<Vec3f> made;
  Buffer<Vec3f> normals = face_normals(mesh);
  Buffer<float> rooms = rooms_at_sides(mesh, nullptr, 1);

  [[nodiscard]] std::vector<DeviationRange> ranges(const std::vector<uint32_t>& edges) const {
    const DeviationBounds bounds{mesh, normals, rooms, made};
    std::vector<DeviationRange> ranges;
    for (size_t i = 0; i < edges.size(); i += 4) {
      const auto edge = [&](size_t k) { return edges[std::min(i + k, edges.size() - 1)]; };
      const auto four = bounds.find({edge(0), edge(1), edge(2), edge(3)});
      ranges.insert(ranges.end(), four.begin(),
                    four.begin() + std::min<ptrdiff_t>(4, std::ssize(edges) - std::ssize(ranges)));
    }
    return ranges;
  }
  [[nodiscard]] std::vector<DeviationRange> all_ranges() const {
    std::vector<uint32_t> edges(mesh.topology.edge_count());
    std::iota(edges.begin(), edges.end(), 0U);
    return ranges(edges);
  }
  /// How many ranges are as narrow as this share of their edge.
  [[nodiscard]] size_t count_narrow(double share) const {
    const auto found = all_ranges();
    size_t count = 0;
    for (uint32_t e = 0; e < found.size(); ++e) {
      const uint32_t h = mesh.topology.half_edge[e];
      const double size =
          length(to_double(mesh.positions[mesh.topology.tip(h)]) - to_double(mesh.positions[mesh.topology.origin[h]]));
      count += found[e].most - found[e].least <= share * size ? 1 : 0;
    }
    return count;
  }
};

void expect_ranges_hold(const Tried& tried) {
  const auto found = tried.all_ranges();
  for (uint32_t e = 0; e < found.size(); ++e) {
    const double exact = deviation(tried.mesh, e, tried.made[e]);
    ASSERT_LE(found[e].least, exact) << e;
    ASSERT_GE(found[e].most, exact) << e;
  }
}

/// Pairs of triangles, and new vertices near the middles of their edges. `flat`: how far the apexes are from the edge's
/// line at most, as a share; `size` of all, `far` away from the origin.
Tried pairs(std::mt19937& random, float flat, float size, float far) {
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto somewhere = [&](float share) {
    return Vec3f{share * uniform(random), share * uniform(random), share * uniform(random)};
  };
  TriangleMesh triangles;
  for (uint32_t i = 0; i < 100; ++i) {
    const Vec3f a = somewhere(1);
    const Vec3f b = somewhere(1);
    for (const Vec3f p : {a, b, a + uniform(random) * (b - a) + somewhere(flat), 0.5F * (a + b) + somewhere(flat)})
      triangles.positions.push_back(size * p + Vec3f{far, 0, -far});
    triangles.triangles.push_back({4 * i, 4 * i + 1, 4 * i + 2});
    triangles.triangles.push_back({4 * i + 1, 4 * i, 4 * i + 3});
  }
  Mesh mesh = build_mesh(triangles);
  Buffer<Vec3f> made(mesh.topology.edge_count());
  for (uint32_t e = 0; e < made.size(); ++e) {
    const auto middle = to_float(midpoint(mesh, e));
    made[e] = middle + somewhere(size * std::pow(10.0F, 3 * uniform(random) - 3.5F));
  }
  return {std::move(mesh), std::move(made)};
}

TEST(DeviationRange, ContainsTheDeviation) {
  std::mt19937 random(7);
  for (int power = -36; power <= 17; ++power)
    for (const float flat : {1.0F, 1e-2F, 1e-4F, 1e-6F, 0.0F})
      for (const float far : {0.0F, 1.0F, 1000.0F}) {
        SCOPED_TRACE("1e" + std::to_string(power) + ", flat " + std::to_string(flat));
        const float size = std::pow(10.0F, static_cast<float>(power));
        if (far * size > 5e17F) continue;  // beyond that meshes are refused
        expect_ranges_hold(pairs(random, flat, size, far * size));
      }
}

TEST(DeviationRange, IsMostlyNextToNothing) {
  std::mt19937 random(3);
  const Tried any = pairs(random, 1, 1, 0);
  EXPECT_GT(any.count_narrow(1e-4), any.made.size() / 20);
  for (const float size : {1e-5F, 1.0F, 1e5F}) {
    Mesh mesh = build_mesh(test::torus(20, 12, size, 0.4F * size));
    Buffer<Vec3f> made =
        butterfly(mesh.topology, mesh.positions, SplitPlan(EdgeMarks(mesh.topology.edge_count(), 1)), 0.0F);
    const Tried torus{std::move(mesh), std::move(made)};
    expect_ranges_hold(torus);
    EXPECT_EQ(torus.count_narrow(1e-4), torus.made.size()) << size;
  }
}

TEST(DeviationRange, IsTheSameAmongHoweverManyEdges) {
  std::mt19937 random(11);
  const Tried tried = pairs(random, 0.3F, 1, 0);
  const auto all = tried.all_ranges();
  for (uint32_t count = 1; count <= 9; ++count) {
    std::vector<uint32_t> edges(count);
    for (uint32_t& e : edges) e = static_cast<uint32_t>(random() % all.size());
    const auto some = tried.ranges(edges);
    for (uint32_t i = 0; i < count; ++i) {
      EXPECT_EQ(some[i].least, all[edges[i]].least);
      EXPECT_EQ(some[i].most, all[edges[i]].most);
    }
  }
}

TEST(RoomsAtSides, AreHowFarTheOtherSidesAreFromAMiddle) {
  const Mesh mesh =
      build_mesh({{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 3, 1}, {0, 0, 1e-6F}}, {{0, 1, 2}, {2, 1, 3}, {0, 2, 4}}});
  const Buffer<float> rooms = rooms_at_sides(mesh, nullptr, 1);
  ASSERT_EQ(rooms.size(), 3U);
  EXPECT_LE(rooms[0], std::sqrt(0.5F));
  EXPECT_GE(rooms[0], 0.98F * std::sqrt(0.5F));
  EXPECT_GT(rooms[1], 0);
  EXPECT_EQ(rooms[2], 0) << "too narrow";
}

TEST(RoomsAtSides, AreOfWhatIsAskedFor) {
  const Mesh mesh = build_mesh(test::torus(16, 10));
  const Buffer<float> all = rooms_at_sides(mesh, nullptr, 1);
  Buffer<uint32_t> fours;
  for (uint32_t i = 0; i + 1 < all.size() / 4; ++i)
    if (i != 1) fours.push_back(i);
  for (const int threads : {1, 2}) {
    const Buffer<float> some = rooms_at_sides(mesh, &fours, threads);
    ASSERT_EQ(some.size(), all.size());
    for (uint32_t i : fours)
      for (uint32_t f = 4 * i; f < 4 * i + 4; ++f) EXPECT_EQ(some[f], all[f]) << f;
  }
}

}  // namespace
}  // namespace papilio
