#include "core/criteria/lighting.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/criteria/camera.h"
#include "core/mesh/normals.h"
#include "papilio/refine.h"
#include "tests/support/rasteriser.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"
#include "tests/support/uniform_hierarchy.h"

namespace papilio {
namespace {

using namespace test;

/// Orthographic view from +z with 100 pixels per unit.
View flat_view(std::vector<Vec3d> lights) {
  View view;
  view.fov_y = 90;
  view.eye = {0, 0, 1};
  view.viewport = {200, 200};
  view.projection = Projection::orthographic;
  view.lights = std::move(lights);
  return view;
}

/// Two faces that meet in an edge of length 1 along y; their normals lean to the right of +z by these angles.
Mesh roof(double left, double right) {
  const auto along = [](double side, double lean) {
    return to_float({side * std::cos(lean), 0, -side * std::sin(lean)});
  };
  return build_mesh({.positions = {{0, -0.5F, 0}, {0, 0.5F, 0}, along(-1, left), along(1, right)},
                     .triangles = {{0, 1, 2}, {1, 0, 3}}});
}

double weight(const Mesh& mesh, const View& view, double distance = 1e-3) {
  uint32_t edge = 0;
  while (mesh.topology.kind[edge] != EdgeKind::smooth) ++edge;
  return light_weight(mesh, face_normals(mesh), edge, distance, view, Camera(view));
}

constexpr double floor_weight = 0.4;

TEST(LightWeight, EvenlyLitAndUnlitEdgesHaveTheFloorWeight) {
  EXPECT_NEAR(weight(roof(0, 0), flat_view({{0, 0, 1}})), floor_weight, 1e-6);
  EXPECT_NEAR(weight(roof(0, 0), flat_view({{0, 0, -1}})), floor_weight, 1e-6);
  EXPECT_NEAR(weight(roof(-0.2, 0.2), flat_view({{0, 0, -1}})), floor_weight, 1e-6);
  EXPECT_NEAR(weight(roof(-0.2, 0.2), flat_view({{0, 0, 1}, {0, 0, 1}})), floor_weight, 1e-6) << "both faces are white";
}

TEST(LightWeight, WeightGrowsWithShadingSlopeAndChange) {
  for (double angle : {0.3, 0.8, 1.4}) {
    const View view = flat_view({{std::sin(angle), 0, std::cos(angle)}});
    EXPECT_NEAR(weight(roof(0, 0), view), std::hypot(floor_weight, 1.3 * std::sin(angle)), 1e-6);
    const double change = std::cos(angle - 0.1) - std::cos(angle + 0.1);
    const double slope = (std::sin(angle - 0.1) + std::sin(angle + 0.1)) / 2;
    const double shading = 1.3 * (2 * change + slope) * std::sqrt(std::cos(0.1));
    EXPECT_NEAR(weight(roof(-0.1, 0.1), view), std::hypot(floor_weight, shading), 1e-6);
  }
}

TEST(LightWeight, SilhouetteEdgesWeighMostIfLit) {
  const Mesh silhouette = roof(1, 2);
  const View dark = flat_view({{-1, 0, 0}});
  const View lit = flat_view({{0, 0, 1}});
  // The edge has 100 pixels and a deviation of 0.1.
  EXPECT_NEAR(weight(silhouette, dark), std::hypot(floor_weight, 0.8 * 0.3 * 10), 1e-6);
  const double outline = 0.8 * (0.3 + 0.7 * std::cos(1.0)) * 10;
  const double shading = 1.3 * (2 * std::cos(1.0) + std::sin(1.0) / 2) * std::sqrt(std::cos(1.0) / 2);
  EXPECT_NEAR(weight(silhouette, lit), std::hypot(floor_weight, shading, outline), 1e-6);
  EXPECT_GT(weight(silhouette, lit), 2 * weight(roof(1, 1.5), lit));
  EXPECT_GT(weight(silhouette, lit), 2 * weight(roof(-0.3, 0.3), lit));
}

TEST(LightWeight, OutlineWeightEqualsTheClosedForm) {
  const Mesh open = roof(0, 0);
  const View view = flat_view({{0, 0, 1}});
  const uint32_t edge = open.topology.edge[1];
  ASSERT_EQ(open.topology.kind[edge], EdgeKind::boundary);
  const double pixels = 100 * std::hypot(1, 0.5);
  for (double distance : {1e-4, 0.01, 0.02, 0.2}) {
    const double expected = std::hypot(floor_weight, 0.8 * std::sqrt(pixels / std::max(1.0, 100 * distance)));
    EXPECT_NEAR(light_weight(open, face_normals(open), edge, distance, view, Camera(view)), expected, 1e-5);
  }
}

TEST(LightWeight, WeightDoesNotDependOnLengthOrOrderOfLights) {
  const Mesh mesh = roof(0.2, 0.7);
  const double expected = weight(mesh, flat_view({{0.4, 0.1, 0.3}, {-1, 0, 0.2}}));
  EXPECT_NEAR(weight(mesh, flat_view({{4e9, 1e9, 3e9}, {-1e-9, 0, 0.2e-9}})), expected, 1e-12);
  EXPECT_NEAR(weight(mesh, flat_view({{-1, 0, 0.2}, {0.4, 0.1, 0.3}})), expected, 1e-12) << "depends on their order";
}

TEST(LightWeight, WeightIsPositiveAndFiniteForAnyEdge) {
  const Mesh flat = build_mesh({.positions = {{0, 0, 0}, {0, 1, 0}, {0, 0.5F, 0}, {1, 0, 0}},
                                .triangles = {{0, 1, 2}, {1, 0, 3}}});  // one face has no area
  for (const Mesh& mesh : {flat, roof(0, 0), roof(1, 2), roof(2, 2)}) {
    View view = flat_view({{1, 1, 1}});
    for (Projection projection : {Projection::perspective, Projection::orthographic}) {
      view.projection = projection;
      for (Vec3d eye : {Vec3d{0, 0, 1}, Vec3d{0, 0, -1e-9}, Vec3d{3, 0, 0}}) {
        view.eye = eye;
        view.target = eye - Vec3d{0, 0, 1};
        for (double distance : {0.0, 1e-30, 1.0, 1e18}) {
          EXPECT_GT(weight(mesh, view, distance), 0);
          EXPECT_TRUE(std::isfinite(weight(mesh, view, distance)));
        }
      }
    }
  }
}

/// View of the mesh in the middle of the picture, from this direction.
View view_of(const Mesh& mesh, Vec3d direction, std::vector<Vec3d> lights) {
  const Box box = bounding_box(mesh.positions);
  View view;
  view.target = 0.5 * (to_double(box.min) + to_double(box.max));
  view.eye = view.target + (1.1 * box.diagonal() / length(direction)) * direction;
  view.viewport = {320, 320};
  view.edge_pixels = 0;
  view.lights = std::move(lights);
  return view;
}

/// One light from the front, two from the sides.
const std::vector<std::vector<Vec3d>> lights{{{1, 1, 1}}, {{-1, 0.5, 0.2}, {0.2, 1, -0.3}}};
const std::vector<Vec3d> directions{{0.3, 0.2, 1}, {1, 0.3, -0.2}};

struct Picture {
  const char* mesh;
  double gain;  ///< decibels; slightly below the smallest measured gain of four pictures
};

class LightingOnRealMeshes : public ::testing::TestWithParam<Picture> {};

TEST_P(LightingOnRealMeshes, LightingImprovesThePictureAtEqualFaceCount) {
  const Mesh coarse = build_mesh(real_mesh(GetParam().mesh));
  const Mesh uniform = refine(coarse, Options{.levels = 3}).mesh;
  for (Vec3d direction : directions) {
    for (size_t i = 0; i < lights.size(); ++i) {
      const View lit = view_of(coarse, direction, lights[i]);
      View unlit = lit;
      unlit.lights.clear();
      const Image reference = render(uniform, lit);
      const uint64_t budget = coarse.topology.face_count() * 7 / 2;
      const auto quality = [&](const View& view) {
        const Result result = refine(coarse, Options{.levels = 3, .view = view, .max_faces = budget});
        EXPECT_LE(result.mesh.topology.face_count(), budget);
        EXPECT_GE(static_cast<double>(result.mesh.topology.face_count()), 0.98 * static_cast<double>(budget));
        return psnr(reference, render(result.mesh, lit));
      };
      EXPECT_GT(quality(lit), quality(unlit) + GetParam().gain) << "from x = " << direction.x << ", lights " << i;
    }
  }
}

TEST_P(LightingOnRealMeshes, VerticesDoNotDependOnLights) {
  const Mesh coarse = build_mesh(real_mesh(GetParam().mesh));
  Options options{.levels = 2};
  const UniformHierarchy uniform(coarse, options);
  options.view = view_of(coarse, directions[0], lights[1]);
  options.view->error_pixels = 0.2;
  const Mesh mesh = refine(coarse, options).mesh;
  EXPECT_GT(mesh.topology.face_count(), coarse.topology.face_count());
  EXPECT_LT(mesh.topology.face_count(), uniform.finest().topology.face_count());
  EXPECT_TRUE(uniform.contains(mesh));
}

std::string test_name(const ::testing::TestParamInfo<Picture>& info) {
  std::string name = info.param.mesh;
  std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
  return name;
}

INSTANTIATE_TEST_SUITE_P(Lighting, LightingOnRealMeshes,
                         ::testing::Values(Picture{"bunny600.obj", 0.5}, Picture{"elephant2000.obj", 0.05},
                                           Picture{"cgal/helmet.off", 0.5}, Picture{"cgal/pig.off", 0.3},
                                           Picture{"cgal/nefertiti.off", 0.4}),
                         test_name);

TEST(Lighting, ToleranceInPixelsIsFinerOnTheLitSide) {
  const Mesh coarse = build_mesh(icosahedron());
  View view = view_of(coarse, {0, 0, 1}, {{1, 0, 0.2}});
  view.error_pixels = 0.3;
  const Mesh mesh = refine(coarse, Options{.levels = 5, .view = view}).mesh;
  std::array<int, 2> faces{};
  for (const Triangle& t : mesh.triangles().triangles) {
    const double x = double{mesh.positions[t[0]].x} + mesh.positions[t[1]].x + mesh.positions[t[2]].x;
    ++faces[x > 0 ? 1 : 0];
  }
  EXPECT_GT(faces[1], faces[0] * 5 / 4);
}

}  // namespace
}  // namespace papilio
