#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <span>

#include "core/criteria/selection.h"
#include "core/detail/surface_tree.h"
#include "core/hierarchy/hierarchy.h"
#include "core/hierarchy/level_choice.h"
#include "core/hierarchy/level_surface.h"
#include "core/hierarchy/prisms.h"
#include "papilio/refine.h"
#include "tests/support/shapes.h"

// Faces of the uniform surface and triangles near points, as a comparison of surfaces finds them.

namespace papilio {
namespace {

TEST(Prisms, PointsWithinATriangleAreThoseOfItsDistance) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1, 1);
  const auto point = [&] { return Vec3d{place(random), place(random), 0.3 * place(random)}; };
  int within = 0;
  for (int i = 0; i < 20'000; ++i) {
    TriangleCorners triangle{point(), point(), point()};
    if (i % 50 == 0) triangle.c = 0.5 * (triangle.a + triangle.b);  // without area
    const Vec3d at = point();
    const double distance = squared_distance(at, triangle);
    for (const double enough : {0.5 * distance, 0.999 * distance, 1.001 * distance, 3 * distance}) {
      double squared = 0;
      ASSERT_EQ(Prism(triangle).is_within(at, enough, squared), distance <= enough) << i;
      if (distance > enough) continue;
      ASSERT_NEAR(squared, distance, 1e-12);
      ++within;
    }
  }
  EXPECT_GT(within, 30'000);
}

TEST(LevelSurface, FaceBelowAPointIsFoundFromEveryFaceBeside) {
  const Options options{.levels = 1, .tension = Tension::off, .shape = Shape::plain};
  const auto level = std::make_shared<HierarchyLevel>(coarsest_level(build_mesh(test::torus(12, 8))));
  level->trial = try_split(level->mesh, options, {.features = &level->features});
  const LevelChoice choice = choose_coarsest(level);
  const ResultSurface result(std::span(&choice, 1));
  LevelSurface surface(result);
  const Mesh& coarse = level->mesh;
  const SurfaceTree uniform(refine(coarse, options).mesh.triangles());
  constexpr double height = 1e-3, enough = 0.1 * 0.1;  // so that a face beside would be near enough, too
  for (uint32_t f = 0; f < uniform.surface().triangles.size(); ++f) {
    const auto [a, b, c] = uniform.corners(f);
    const Vec3d point = 1.0 / 3 * (a + b + c) + height * uniform.unit_normal(f);
    for (uint32_t i = 0; i < 4; ++i) {
      const uint32_t from = i < 3 ? coarse.topology.twin[3 * (f / 4) + i] / 3 : f / 4;
      const LevelSurface::Nearest found = surface.nearest({0, from}, 0, point, enough);
      ASSERT_NEAR(found.squared, height * height, 1e-9) << f << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace papilio
