#include "client/mesh_file/polygon.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <random>

namespace papilio::client {
namespace {

using testing::ElementsAre;
using Corners = std::vector<Vec3f>;

Buffer<Triangle> cut(const Corners& corners) {
  std::vector<uint32_t> numbers(corners.size());
  std::iota(numbers.begin(), numbers.end(), 0U);
  Buffer<Triangle> triangles;
  append_polygon(
      numbers, [&](uint32_t i) { return corners[i]; }, triangles);
  return triangles;
}

Buffer<Triangle> fan(uint32_t corners) {
  Buffer<Triangle> triangles;
  for (uint32_t i = 2; i < corners; ++i) triangles.push_back({0, i - 1, i});
  return triangles;
}

/// Twice the area vector of a polygon.
Vec3d area_vector(const Corners& corners) {
  Vec3d area;
  for (size_t i = 0; i < corners.size(); ++i)
    area += cross(to_double(corners[i]), to_double(corners[(i + 1) % corners.size()]));
  return area;
}

/// Expects a tiling of a plane polygon: all triangles have its orientation, their areas add up to its area, and each
/// inner edge has two triangles.
void expect_tiling(const Corners& corners, const Buffer<Triangle>& triangles) {
  const Vec3d area = area_vector(corners);
  ASSERT_EQ(triangles.size(), corners.size() - 2);
  double sum = 0;
  std::map<std::pair<uint32_t, uint32_t>, int> sides;
  for (const Triangle& t : triangles) {
    const double share = dot(area_vector({corners[t[0]], corners[t[1]], corners[t[2]]}), area) / dot(area, area);
    EXPECT_GT(share, 0) << t[0] << " " << t[1] << " " << t[2];
    sum += share;
    for (int i = 0; i < 3; ++i) {
      ++sides[{t[i], t[(i + 1) % 3]}];
      --sides[{t[(i + 1) % 3], t[i]}];
    }
  }
  EXPECT_NEAR(sum, 1, 1e-6);
  for (const auto& [side, count] : sides) {
    const bool follows = (side.first + 1) % corners.size() == side.second;
    const bool precedes = (side.second + 1) % corners.size() == side.first;
    EXPECT_EQ(count, follows ? 1 : precedes ? -1 : 0) << side.first << " " << side.second;
  }
}

/// Returns the corners from another first corner, tilted out of all coordinate planes.
Corners tilted(Corners corners, size_t first = 0) {
  std::ranges::rotate(corners, corners.begin() + static_cast<ptrdiff_t>(first));
  for (Vec3f& p : corners) p = {0.5F * p.x - p.y + 100, 3 * p.x + p.y, 2 * p.y - 0.25F * p.x};
  return corners;
}

Corners random_star(std::mt19937& random, size_t count) {
  Corners corners;
  std::uniform_real_distribution<double> radius(0.1, 1);
  for (size_t i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    const double r = radius(random);
    corners.push_back(to_float({r * std::cos(angle), r * std::sin(angle), 0}));
  }
  return corners;
}

Corners comb(size_t teeth) {
  Corners corners;
  for (size_t i = 0; i < teeth; ++i) {
    const auto x = static_cast<float>(4 * i);
    corners.insert(corners.end(), {{x, 0, 0}, {x + 1, 9, 0}, {x + 2, 9, 0}, {x + 3, 0, 0}});
  }
  corners.push_back({corners.back().x, -1, 0});
  corners.push_back({0, -1, 0});
  std::ranges::reverse(corners);
  return corners;
}

TEST(Polygon, SquareKeepsTheDiagonalAtItsFirstCorner) {
  Corners square{{0.3F, 0.1F, 0.1F}, {1.3F, 0.1F, 0.1F}, {1.3F, 1.1F, 0.1F}, {0.3F, 1.1F, 0.1F}};
  for (size_t first = 0; first < 4; ++first) {
    EXPECT_THAT(cut(square), ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
    std::ranges::rotate(square, square.begin() + 1);
  }
}

TEST(Polygon, FlatQuadIsCutWhereItsSmallestAngleIsLargest) {
  const Corners rhombus{{-2, 0, 0}, {0, -1, 0}, {2, 0, 0}, {0, 1, 0}};
  EXPECT_THAT(cut(rhombus), ElementsAre(Triangle{0, 1, 3}, Triangle{1, 2, 3}));
  EXPECT_THAT(cut(tilted(rhombus, 1)), ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

TEST(Polygon, ConcaveQuadIsCutInsideFromEveryFirstCorner) {
  const Corners dart{{0, 0, 0}, {4, 1, 0}, {1, 1, 0}, {1, 4, 0}};
  for (size_t first = 0; first < 4; ++first) {
    const Corners corners = tilted(dart, first);
    expect_tiling(corners, cut(corners));
  }
}

TEST(Polygon, CornerOnTheSideOfAQuadMakesNoFaceWithoutArea) {
  const Corners side{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  for (size_t first = 0; first < 4; ++first) expect_tiling(tilted(side, first), cut(tilted(side, first)));
}

TEST(Polygon, BentQuadIsCutAtTheSmallerFold) {
  // A fold of 81 degrees instead of 126, though the other diagonal has the larger smallest angle.
  const Corners bent{{0, 0, 0}, {4, 0, 0}, {1, 2, 0}, {0, 1, 3}};
  EXPECT_THAT(cut(bent), ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
  EXPECT_THAT(cut({bent[1], bent[2], bent[3], bent[0]}), ElementsAre(Triangle{0, 1, 3}, Triangle{1, 2, 3}));
}

TEST(Polygon, GridOfNearSquaresKeepsOneDirection) {
  const Corners quad{{0, 0, 0}, {1, 0.1F, 0}, {1.1F, 1.1F, 0.1F}, {-0.05F, 1, 0}};
  EXPECT_THAT(cut(quad), ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
  EXPECT_THAT(cut({quad[1], quad[2], quad[3], quad[0]}), ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

TEST(Polygon, SlightlyBentConcaveQuadIsCutInside) {
  const Corners dart{{0, 0, 0}, {4, 1, 0}, {1, 1, 0.05F}, {1, 4, 0}};
  for (size_t first = 0; first < 4; ++first) {
    Corners corners = dart;
    std::ranges::rotate(corners, corners.begin() + static_cast<ptrdiff_t>(first));
    for (const Triangle& t : cut(corners)) EXPECT_GT(area_vector({corners[t[0]], corners[t[1]], corners[t[2]]}).z, 0);
  }
}

TEST(Polygon, ConcavePolygonsAreTiled) {
  std::mt19937 random(7);
  for (const size_t count : {5, 6, 7, 12, 40, 200})
    for (int i = 0; i < 20; ++i) {
      const Corners corners = tilted(random_star(random, count));
      expect_tiling(corners, cut(corners));
    }
  for (const size_t teeth : {1, 2, 30, 255}) expect_tiling(tilted(comb(teeth)), cut(tilted(comb(teeth))));
}

TEST(Polygon, ReversedOrientationIsKept) {
  Corners corners = comb(4);
  std::ranges::reverse(corners);
  expect_tiling(corners, cut(corners));
}

TEST(Polygon, PolygonWithABridgedHoleIsTiled) {
  const Corners corners{{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}, {0, 0, 0},
                        {3, 3, 0}, {3, 6, 0}, {6, 6, 0}, {6, 3, 0}, {3, 3, 0}};
  const Buffer<Triangle> triangles = cut(corners);
  ASSERT_EQ(triangles.size(), 8U);
  double area = 0;
  for (const Triangle& t : triangles) {
    const Vec3d twice = area_vector({corners[t[0]], corners[t[1]], corners[t[2]]});
    EXPECT_GT(twice.z, 0);
    area += twice.z / 2;
  }
  EXPECT_DOUBLE_EQ(area, 81 - 9);
}

TEST(Polygon, CornersOnTheSidesMakeNoFacesWithoutArea) {
  Corners square;
  for (const Vec3f corner : {Vec3f{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}) {
    const Vec3f along =
        corner.x == corner.y ? Vec3f{corner.x == 0 ? 1.F : -1.F, 0, 0} : Vec3f{0, corner.x > 0 ? 1.F : -1.F, 0};
    for (int i = 0; i < 4; ++i) square.push_back(corner + static_cast<float>(i) * along);
  }
  expect_tiling(square, cut(square));
}

TEST(Polygon, CircleHasAtMostNineFacesPerCorner) {
  Corners circle;
  for (int i = 0; i < 32; ++i)
    circle.push_back(to_float({std::cos(i * std::numbers::pi / 16), std::sin(i * std::numbers::pi / 16), 0}));
  const Buffer<Triangle> triangles = cut(circle);
  expect_tiling(circle, triangles);
  std::vector<int> faces(circle.size());
  for (const Triangle& t : triangles)
    for (const uint32_t corner : t) ++faces[corner];
  EXPECT_LE(std::ranges::max(faces), 9);  // a fan has 30
}

TEST(Polygon, PolygonWithoutATilingBecomesAFan) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(cut({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, -3, 0}, {0, 4, 0}}), fan(5)) << "crosses itself";
  EXPECT_EQ(cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}), fan(5)) << "no area";
  EXPECT_EQ(cut({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}), fan(4)) << "no extent";
  EXPECT_EQ(cut({{0, 0, 0}, {4, 1, 0}, {nan, 1, 0}, {1, 4, 0}}), fan(4)) << "not finite";
  EXPECT_EQ(cut({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}), fan(4)) << "a bow tie";
  EXPECT_EQ(cut({{0, 0, 0}, {4, 0, 1}, {4, 4, 0}, {1, 1, 1}, {0, 4, 0}}), fan(5)) << "bent";
  EXPECT_EQ(cut(comb(most_clipped_corners / 4)), fan(most_clipped_corners + 2)) << "too many corners";
}

TEST(Polygon, ResultDoesNotDependOnScale) {
  for (const float scale : {1e-30F, 1e-9F, 1e9F, 1e30F}) {
    Corners corners = comb(3);
    for (Vec3f& p : corners) p = scale * p;
    EXPECT_EQ(cut(corners), cut(comb(3)));
  }
}

}  // namespace
}  // namespace papilio::client
