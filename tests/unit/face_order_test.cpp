#include "core/detail/face_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/support/shapes.h"

namespace papilio {
namespace {

using test::grid;

/// Small triangles at the corners of a cube, bit i of a corner's number telling its coordinate i.
TriangleMesh corners_of_cube(std::initializer_list<uint32_t> corners) {
  TriangleMesh mesh;
  for (const uint32_t corner : corners) {
    const auto at = [&](uint32_t axis) { return static_cast<float>(corner >> axis & 1U); };
    const auto point = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.push_back({at(0), at(1), at(2)});
    mesh.positions.push_back({at(0) + 0.01F, at(1), at(2)});
    mesh.positions.push_back({at(0), at(1) + 0.01F, at(2)});
    mesh.triangles.push_back({point, point + 1, point + 2});
  }
  return mesh;
}

TEST(FaceOrder, CornersOfACubeAreInBinaryOrder) {
  const TriangleMesh mesh = corners_of_cube({5, 2, 7, 0, 3, 6, 1, 4});
  const TriangleMesh ordered = along_morton_curve(mesh);
  for (uint32_t i = 0; i < 8; ++i) {
    const Vec3f at = ordered.positions[ordered.triangles[i][0]];
    EXPECT_EQ(at, (Vec3f{static_cast<float>(i & 1U), static_cast<float>(i >> 1U & 1U), static_cast<float>(i >> 2U)}));
  }
}

TEST(FaceOrder, OrderDoesNotDependOnThatOfTheInput) {
  const TriangleMesh mesh = grid(40, 30);
  TriangleMesh shuffled = mesh;
  std::ranges::shuffle(shuffled.triangles, std::mt19937(1));
  const TriangleMesh ordered = along_morton_curve(shuffled);
  EXPECT_EQ(ordered, along_morton_curve(mesh));
  EXPECT_EQ(ordered.positions, mesh.positions);
  EXPECT_TRUE(std::ranges::is_permutation(ordered.triangles, mesh.triangles));
}

TEST(FaceOrder, SuccessiveFacesAreNear) {
  TriangleMesh mesh = grid(64, 64);
  std::ranges::shuffle(mesh.triangles, std::mt19937(2));
  const auto mean_step = [](const TriangleMesh& of) {
    double sum = 0;
    for (size_t i = 1; i < of.triangles.size(); ++i)
      sum += length(to_double(of.positions[of.triangles[i][0]]) - to_double(of.positions[of.triangles[i - 1][0]]));
    return sum / static_cast<double>(of.triangles.size() - 1);
  };
  const double edge = length(to_double(mesh.positions[1]) - to_double(mesh.positions[0]));
  EXPECT_GT(mean_step(mesh), 20 * edge);
  EXPECT_LT(mean_step(along_morton_curve(mesh)), 3 * edge);
}

TEST(FaceOrder, MeshesWithoutExtentStayAsTheyAre) {
  EXPECT_EQ(along_morton_curve({}), TriangleMesh{});
  const TriangleMesh point{.positions = {{1, 2, 3}}, .triangles = {{0, 0, 0}, {0, 0, 0}}};
  EXPECT_EQ(along_morton_curve(point), point);
}

}  // namespace
}  // namespace papilio
