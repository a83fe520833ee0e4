#include "client/lib/compare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <stdexcept>
#include <utility>

#include "client/lib/surface_distance.h"

namespace papilio::client {
namespace {

TriangleMesh cube(float side, Vec3f low = {}) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(
        low + side * Vec3f{static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1), static_cast<float>(i >> 2)});
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TriangleMesh square(float height) {
  return {{{0, 0, height}, {1, 0, height}, {1, 1, height}, {0, 1, height}}, {{0, 1, 2}, {0, 2, 3}}};
}

/// An icosahedron, each face split in four `levels` times, all vertices at `radius`.
TriangleMesh sphere(double radius, int levels) {
  const double g = std::numbers::phi;
  std::vector<Vec3d> points{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                            {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  Buffer<Triangle> faces{{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                         {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                         {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t i, uint32_t j) {
      const auto [place, is_new] = middles.try_emplace(std::minmax(i, j), static_cast<uint32_t>(points.size()));
      if (is_new) points.push_back(0.5 * (points[i] + points[j]));
      return place->second;
    };
    Buffer<Triangle> finer;
    for (const auto& [a, b, c] : faces) {
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    faces = finer;
    for (Vec3d& p : points) p = (1 / length(p)) * p;
  }
  TriangleMesh mesh{{}, faces};
  for (const Vec3d& p : points) mesh.positions.push_back(to_float((radius / length(p)) * p));
  return mesh;
}

/// Options with few samples, for results that do not depend on their number.
constexpr CompareOptions kFew{.samples = 3000};

TEST(Compare, IdenticalMeshesHaveZeroDistance) {
  for (const TriangleMesh& mesh : {cube(1), square(0), sphere(2, 2)}) {
    const Comparison found = compare(mesh, mesh, kFew);
    EXPECT_NEAR(found.hausdorff, 0, 1e-14);
    EXPECT_NEAR(found.rms, 0, 1e-14);
    EXPECT_NEAR(found.normal_degrees_mean, 0, 1e-4);
  }
}

TEST(Compare, DistanceOfAShiftedPlaneIsTheShift) {
  const Comparison found = compare(square(0), square(0.25F));
  EXPECT_DOUBLE_EQ(found.hausdorff, 0.25);
  EXPECT_NEAR(found.rms, 0.25, 1e-12);
  EXPECT_DOUBLE_EQ(found.max_forward, 0.25);
  EXPECT_DOUBLE_EQ(found.max_backward, 0.25);
  EXPECT_NEAR(found.rms_forward, 0.25, 1e-12);
  EXPECT_NEAR(found.rms_backward, 0.25, 1e-12);
  EXPECT_DOUBLE_EQ(found.diagonal, std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(found.normal_degrees_mean, 0);
}

TEST(Compare, NestedCubesHaveTheExactDistances) {
  // The large cube's corner is sqrt(3) from the small one's; from within, every face is 1 away.
  const Comparison found = compare(cube(2), cube(4, {-1, -1, -1}));
  EXPECT_DOUBLE_EQ(found.max_forward, 1);
  EXPECT_NEAR(found.rms_forward, 1, 1e-12);
  EXPECT_DOUBLE_EQ(found.max_backward, std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(found.hausdorff, std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(found.diagonal, std::sqrt(12.0));
  EXPECT_NEAR(found.normal_degrees_mean, 0, 1e-4);
  // On a face of 4 x 4, the distance squared is 1 + e(x)^2 + e(y)^2, e the excess over the inner side: mean 1
  // + 2 / 6.
  EXPECT_NEAR(found.rms_backward, std::sqrt(4.0 / 3.0), 1e-3);
}

TEST(Compare, ShiftedCubeHasTheExactDistances) {
  const Comparison found = compare(cube(1), cube(1, {0.25F, 0, 0}));
  EXPECT_DOUBLE_EQ(found.hausdorff, 0.25);
  // Mean squares over one mesh's faces: the left one 1/16; the four around it (1/4)^3 / 3 each; the right
  // one, within the other mesh and nearer to its sides along the border, the integral of 2t (1 - 2t)^2 from 0
  // to 1/4.
  const double left = 1.0 / 16, around = 4.0 / 192, right = 1.0 / 16 - 8.0 / 192 + 2.0 / 256;
  EXPECT_NEAR(found.rms, std::sqrt((left + around + right) / 6), 1e-4);
}

TEST(Compare, ConcentricSpheresDifferByTheirRadii) {
  const double inner = 1, outer = 1.5;
  const Comparison found = compare(sphere(inner, 4), sphere(outer, 4), kFew);
  // Faces of level 4 sag by less than 0.2 % of the radius.
  EXPECT_NEAR(found.hausdorff, outer - inner, 0.004);
  EXPECT_NEAR(found.rms, outer - inner, 0.004);
  EXPECT_LT(found.normal_degrees_mean, 3);
}

TEST(Compare, NormalAngleOfATurnedPlaneIsTheTurn) {
  const float c = std::sqrt(0.75F);
  const TriangleMesh turned{{{0, 0, 0}, {c, 0, 0.5F}, {c, 1, 0.5F}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  EXPECT_NEAR(compare(square(0), turned, kFew).normal_degrees_mean, 30, 1e-3);
  TriangleMesh flipped = square(0);
  for (Triangle& triangle : flipped.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_NEAR(compare(square(0), flipped, kFew).normal_degrees_mean, 180, 1e-4);
}

TEST(Compare, DirectionsDifferWhereAComponentIsMissing) {
  TriangleMesh both = square(0);
  both.positions.insert(both.positions.end(), {{5, 0, 0}, {6, 0, 0}, {5, 1, 0}});
  both.triangles.push_back({4, 5, 6});
  const Comparison found = compare(square(0), both, kFew);
  EXPECT_NEAR(found.max_forward, 0, 1e-14);
  EXPECT_DOUBLE_EQ(found.max_backward, 5);
  EXPECT_DOUBLE_EQ(compare(both, square(0), kFew).max_forward, 5);
}

TEST(Compare, ResultIsDeterministicAndSymmetric) {
  const TriangleMesh a = sphere(1, 3), b = cube(1.5F, {-0.75F, -0.75F, -0.75F});
  const Comparison first = compare(a, b, kFew), second = compare(a, b, kFew);
  EXPECT_EQ(first.hausdorff, second.hausdorff);
  EXPECT_EQ(first.rms, second.rms);
  EXPECT_EQ(first.normal_degrees_mean, second.normal_degrees_mean);
  const Comparison swapped = compare(b, a, kFew);
  EXPECT_EQ(first.rms_forward, swapped.rms_backward);
  EXPECT_EQ(first.hausdorff, swapped.hausdorff);
}

TEST(Compare, UnusedPositionsAreIgnored) {
  TriangleMesh mesh = square(0);
  mesh.positions.push_back({100, 100, 100});
  mesh.positions.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  const Comparison found = compare(mesh, square(0), kFew);
  EXPECT_NEAR(found.hausdorff, 0, 1e-14);
  EXPECT_DOUBLE_EQ(found.diagonal, std::sqrt(2.0));
}

TEST(Compare, DegenerateTrianglesAreSegmentsAndPoints) {
  const TriangleMesh segment{{{0, 0, 0}, {1, 0, 0}, {0.5F, 0, 0}}, {{0, 1, 2}}};
  const TriangleMesh point{{{0, 3, 0}}, {{0, 0, 0}}};
  const Comparison found = compare(segment, point);
  EXPECT_DOUBLE_EQ(found.max_forward, std::sqrt(10.0));
  EXPECT_DOUBLE_EQ(found.max_backward, 3);
  EXPECT_DOUBLE_EQ(found.rms_backward, 3);
  EXPECT_EQ(found.normal_degrees_mean, 0);
  EXPECT_EQ(compare(point, point).diagonal, 0);

  TriangleMesh mixed = square(0);
  mixed.triangles.insert(mixed.triangles.begin(), {{0, 0, 1}, {2, 2, 2}});
  const Comparison same = compare(mixed, square(0), kFew);
  EXPECT_NEAR(same.hausdorff, 0, 1e-14);
  EXPECT_NEAR(same.normal_degrees_mean, 0, 1e-4);
}

TEST(Compare, ExtremeSizesStayFinite) {
  for (const float size : {1e-38F, 1e-30F, 1e30F, 3e38F}) {
    const Comparison found = compare(cube(size), cube(size, {size * 0.0625F, 0, 0}), {.samples = 100});
    EXPECT_NEAR(found.hausdorff / size, 0.0625, 1e-6);
    EXPECT_TRUE(std::isfinite(found.rms));
    EXPECT_TRUE(std::isfinite(found.normal_degrees_mean));
  }
}

TEST(Compare, ZeroSamplesCompareVertices) {
  const Comparison found = compare(square(0), square(2), {.samples = 0});
  EXPECT_DOUBLE_EQ(found.hausdorff, 2);
  EXPECT_DOUBLE_EQ(found.rms, 2);
}

TEST(Compare, EmptyAndInvalidMeshesAreRefused) {
  const TriangleMesh empty;
  TriangleMesh out_of_range = square(0), not_finite = square(0);
  out_of_range.triangles[1][2] = 4;
  not_finite.positions[3].y = std::numeric_limits<float>::infinity();
  for (const TriangleMesh& bad : {empty, out_of_range, not_finite}) {
    EXPECT_THROW((void)compare(bad, square(0)), std::invalid_argument);
    EXPECT_THROW((void)compare(square(0), bad), std::invalid_argument);
  }
  try {
    (void)compare(square(0), empty);
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "the second mesh has no triangles: there is nothing to compare");
  }
}

class Random {
 public:
  Vec3d point() { return {uniform_(engine_), uniform_(engine_), uniform_(engine_)}; }
  /// Returns a random triangle, in some cases degenerate: two or three equal corners, or collinear ones.
  TriangleCorners triangle() {
    const Vec3d a = point(), b = point(), c = point();
    switch (engine_() % 8) {
      case 0:
        return {a, b, a};
      case 1:
        return {a, a, a};
      case 2:
        return {a, b, a + 0.25 * (b - a)};
      default:
        return {a, b, c};
    }
  }

 private:
  std::mt19937 engine_{7};
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

/// Returns the distance to a grid of barycentric points: an upper bound of the exact distance, close to it.
double distance_by_grid(Vec3d point, const TriangleCorners& t) {
  constexpr int kSteps = 200;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; i + j <= kSteps; ++j)
      least =
          std::min(least, length(point - t.a - (1.0 * i / kSteps) * (t.b - t.a) - (1.0 * j / kSteps) * (t.c - t.a)));
  return least;
}

TEST(CompareDistance, TriangleDistanceMatchesAGridOfPoints) {
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const TriangleCorners triangle = random.triangle();
    const Vec3d point = 2.0 * random.point();
    const double exact = std::sqrt(squared_distance(point, triangle));
    const double grid = distance_by_grid(point, triangle);
    EXPECT_LE(exact, grid + 1e-12);
    EXPECT_NEAR(exact, grid, 0.02);
  }
}

TEST(CompareDistance, DistanceEqualsALinearSearch) {
  Random random;
  for (const int count : {1, 2, 4, 5, 9, 100, 1000}) {
    std::vector<TriangleCorners> triangles;
    for (int i = 0; i < count; ++i) {
      // Small triangles, so that the tree prunes nodes.
      const Vec3d centre = random.point();
      const auto [a, b, c] = random.triangle();
      triangles.push_back({centre + 0.2 * a, centre + 0.2 * b, centre + 0.2 * c});
    }
    const SurfaceDistance surface(triangles);
    for (int i = 0; i < 300; ++i) {
      const Vec3d point = 1.5 * random.point();
      double least = std::numeric_limits<double>::infinity();
      for (const TriangleCorners& triangle : triangles) least = std::min(least, squared_distance(point, triangle));
      ASSERT_EQ(surface.distance(point), std::sqrt(least));
      ASSERT_EQ(surface.nearest(point, {1, 0, 0}).distance, std::sqrt(least));
    }
  }
}

TEST(CompareDistance, ManyEqualTrianglesAreAccepted) {
  const std::vector<TriangleCorners> triangles(10'000, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  EXPECT_DOUBLE_EQ(SurfaceDistance(triangles).distance({0.25, 0.25, 3}), 3);
}

TEST(CompareDistance, FaceOfTheMostSimilarNormalIsNearestAtAnEdge) {
  // Two faces at a right angle meet in the x axis; the point is nearest to the edge itself.
  const std::vector<TriangleCorners> triangles{{{0, 0, 0}, {1, 0, 0}, {0, -1, 0}}, {{0, 0, 0}, {1, 0, 0}, {0, 0, -1}}};
  const SurfaceDistance surface(triangles);
  EXPECT_NEAR(*surface.nearest({0.25, 1, 1}, {0, 0, -1}).cosine, 1, 1e-12);
  EXPECT_NEAR(*surface.nearest({0.25, 1, 1}, {0, 1, 0}).cosine, 1, 1e-12);
}

}  // namespace
}  // namespace papilio::client
