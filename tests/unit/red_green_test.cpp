#include "core/schemes/red_green.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>
#include <tuple>

#include "papilio/refine.h"
#include "server/samples/models.h"
#include "tests/support/invariants.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"
#include "tests/support/uniform_hierarchy.h"

namespace papilio {
namespace {

using namespace test;

View view_of(const Mesh& mesh, Vec3d direction) {
  const Box box = bounding_box(mesh.positions);
  View view;
  view.target = 0.5 * (to_double(box.min) + to_double(box.max));
  view.eye = view.target + (0.8 * box.diagonal()) * direction;
  view.edge_pixels = 4;
  return view;
}

void expect_part_of(const UniformHierarchy& uniform, const Mesh& coarse, const Options& options) {
  const auto check = [&](const Level& level) {
    ASSERT_TRUE(uniform.contains(level.mesh)) << "level " << level.level;
    ASSERT_TRUE(is_consistent(level.mesh)) << "level " << level.level;
    ASSERT_EQ(level.mesh.topology.euler_characteristic(), coarse.topology.euler_characteristic());
    ASSERT_TRUE(std::equal(coarse.positions.begin(), coarse.positions.end(), level.mesh.positions.begin()));
  };
  const Result result = refine(coarse, options, {.on_level = check});
  EXPECT_GT(result.mesh.topology.face_count(), coarse.topology.face_count());
  EXPECT_LT(result.mesh.topology.face_count(), uniform.finest().topology.face_count());
  EXPECT_GE(smallest_angle(result.mesh), smallest_angle(uniform.finest()) / 3);
  EXPECT_EQ(refine(coarse, options).mesh.triangles(), result.mesh.triangles()) << "with or without a level callback";
}

class RedGreenOnRealMeshes : public ::testing::TestWithParam<const char*> {};

TEST_P(RedGreenOnRealMeshes, VerticesAreBitIdenticalToUniform) {
  const Mesh coarse = build_mesh(real_mesh(GetParam()));
  for (Tension tension : {Tension::off, Tension::soft, Tension::sharp}) {
    Options options{.levels = 3, .tension = tension, .shape = Shape::plain};
    const UniformHierarchy uniform(coarse, options);
    for (Vec3d direction : {Vec3d{}, Vec3d{0, 0, 1}, Vec3d{1, 0.2, 0}}) {
      if (direction != Vec3d{}) options.view = view_of(coarse, direction);
      SCOPED_TRACE("tension " + std::to_string(static_cast<int>(tension)) + ", view " + std::to_string(direction.x));
      options.tolerance = 0;
      options.flatness = {0.8, 0.9, 0.95};
      expect_part_of(uniform, coarse, options);
      options.flatness = {};
      options.tolerance = 2e-3;
      expect_part_of(uniform, coarse, options);
    }
  }
}

/// Returns the number of positions of the first mesh that the second has bit-identically.
size_t count_common(const Mesh& a, const Mesh& b) {
  const auto less = [](Vec3f p, Vec3f q) { return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z); };
  Buffer<Vec3f> sorted = b.positions;
  std::ranges::sort(sorted, less);
  return static_cast<size_t>(
      std::ranges::count_if(a.positions, [&](Vec3f p) { return std::ranges::binary_search(sorted, p, less); }));
}

TEST_P(RedGreenOnRealMeshes, VerticesOfTwoViewsAreBitIdentical) {
  const Mesh coarse = build_mesh(real_mesh(GetParam()));
  Options options{.levels = 3, .view = view_of(coarse, {0, 0, 1})};
  const Mesh front = refine(coarse, options).mesh;
  options.view = view_of(coarse, {0.8, 0, 0.6});
  const Mesh side = refine(coarse, options).mesh;
  const Mesh all = refine(coarse, {.levels = 3}).mesh;
  EXPECT_EQ(count_common(front, all), front.positions.size());
  EXPECT_EQ(count_common(side, all), side.positions.size());
  EXPECT_GT(count_common(front, side), coarse.positions.size());
  EXPECT_LT(count_common(front, side), front.positions.size());
}

TEST(RedGreen, TransitionFacesKeepAThirdOfTheSmallestAngle) {
  const std::vector<TriangleMesh> meshes{server::mug(), server::wheel(), real_mesh("cgal/pig.off"),
                                         real_mesh("cgal/fandisk.off"), real_mesh("cgal/knot.off")};
  for (const TriangleMesh& triangles : meshes) {
    const Mesh coarse = build_mesh(triangles);
    for (Growth growth : {Growth::off, Growth::faces, Growth::vertices}) {
      const Options options{.levels = 2, .flatness = {0.6, 0.8}, .growth = growth, .tension = Tension::off};
      const Mesh uniform = refine(coarse, {.levels = 2, .tension = Tension::off}).mesh;
      EXPECT_GE(smallest_angle(refine(coarse, options).mesh), smallest_angle(uniform) / 3);
    }
  }
}

TEST(RedGreen, ResultIsBitIdenticalForAnyThreads) {
  const Mesh coarse = build_mesh(real_mesh("bunny600.obj"));
  const Options options{.levels = 3, .view = view_of(coarse, {0, 0, 1}), .tolerance = 1e-3};
  const TriangleMesh expected = refine(coarse, options).mesh.triangles();
  std::array<TriangleMesh, 4> results;
  {
    std::vector<std::jthread> threads;
    for (TriangleMesh& result : results)
      threads.emplace_back([&] { result = refine(coarse, options).mesh.triangles(); });
  }
  for (const TriangleMesh& result : results) EXPECT_EQ(result, expected);
}

std::string test_name(const ::testing::TestParamInfo<const char*>& info) {
  std::string name = info.param;
  std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
  return name;
}

INSTANTIATE_TEST_SUITE_P(RedGreen, RedGreenOnRealMeshes,
                         ::testing::Values("bunny600.obj", "elephant2000.obj", "cgal/rotor_small.off",
                                           "cgal/helmet.off", "cgal/pig.off", "cgal/eight.off", "cgal/nefertiti.off"),
                         test_name);

}  // namespace
}  // namespace papilio
