#include "core/mesh/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "papilio/triangle_distance.h"

namespace papilio {
namespace {

std::vector<uint32_t> near(PointTree& tree, Vec3d a, Vec3d b, double distance) {
  std::vector<uint32_t> found;
  tree.for_each_near(a, b, distance, [&](uint32_t p) {
    found.push_back(p);
    return true;
  });
  std::ranges::sort(found);
  return found;
}

TEST(PointTree, TreeFindsAllPointsOfALinearSearch) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto point = [&] { return Vec3d{coordinate(random), coordinate(random), coordinate(random)}; };
  for (const size_t count : {0, 1, 8, 9, 100, 1000}) {
    std::vector<Vec3d> points(count);
    std::ranges::generate(points, point);
    for (size_t i = 1; i < count; i += 3) points[i] = points[i - 1];  // some repeated
    PointTree tree(points);
    for (int i = 0; i < 50; ++i) {
      const Vec3d a = point(), b = i % 3 == 0 ? a : i % 3 == 1 ? a + Vec3d{1, 0, 0} : point();
      const double distance = i % 2 == 0 ? 0.05 : 0.3;
      std::vector<uint32_t> expected;
      for (uint32_t p = 0; p < count; ++p)
        if (squared_distance_to_segment(points[p], a, b) <= distance * distance) expected.push_back(p);
      EXPECT_EQ(near(tree, a, b, distance), expected);
    }
    EXPECT_FALSE(tree.is_exhausted());
  }
}

TEST(PointTree, VisitorStopsTheSearch) {
  PointTree tree(std::vector<Vec3d>(100));
  int visits = 0;
  tree.for_each_near({}, {}, 1, [&](uint32_t) { return ++visits < 7; });
  EXPECT_EQ(visits, 7);
}

TEST(PointTree, WorkIsBounded) {
  PointTree tree(std::vector<Vec3d>(1000));  // all equal
  size_t visits = 0;
  for (int i = 0; i < 100'000 && !tree.is_exhausted(); ++i) visits += near(tree, {}, {}, 1).size();
  EXPECT_TRUE(tree.is_exhausted());
  EXPECT_LT(visits, 1'000'000U);
  EXPECT_TRUE(near(tree, {}, {}, 1).empty());
}

}  // namespace
}  // namespace papilio
