#include "tests/support/rasteriser.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "papilio/refine.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

View front_view() {
  View view;
  view.viewport = {120, 80};
  view.lights = {{0, 0, 7}};
  return view;
}

/// A square of side 2s at depth z that faces the eye.
void add_square(TriangleMesh& mesh, float s, float z) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (Vec3f p : {Vec3f{-s, -s, z}, Vec3f{s, -s, z}, Vec3f{s, s, z}, Vec3f{-s, s, z}}) mesh.positions.push_back(p);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

Mesh square(float s, float z) {
  TriangleMesh mesh;
  add_square(mesh, s, z);
  return build_mesh(mesh);
}

/// The unit sphere in small faces.
Mesh sphere() {
  Mesh mesh = build_mesh(icosahedron());
  for (int level = 0; level < 5; ++level) {
    mesh = refine(std::move(mesh), Options{.levels = 1}).mesh;
    for (Vec3f& p : mesh.positions) p = (1 / length(p)) * p;
  }
  return mesh;
}

double sum_of(const Image& image) { return std::accumulate(image.grey.begin(), image.grey.end(), 0.0); }

TEST(Rasteriser, ShadeOfAPlaneIsTheCosineToTheLight) {
  View view = front_view();
  for (double angle : {0.0, 0.5, 1.0, 2.0}) {
    view.lights = {{0, 3 * std::sin(angle), 3 * std::cos(angle)}};
    const Image image = render(square(0.5F, 0), view);
    EXPECT_NEAR(image.at(60, 40), std::max(0.0, std::cos(angle)), 1e-6);
    EXPECT_EQ(image.at(2, 2), 0);
  }
  view.lights = {{0, 0, 1}, {0, 1, 1}};
  EXPECT_EQ(render(square(0.5F, 0), view).at(60, 40), 1) << "lights add up, to white at most";
  view.lights.clear();
  EXPECT_EQ(render(square(0.5F, 0), view).at(60, 40), 0);
}

TEST(Rasteriser, SquareCoversTheAreaOfItsProjection) {
  View view = front_view();
  const double pixels = 80 / (2 * std::tan(std::numbers::pi / 8));  // at distance 1
  const double tolerance = 1.4 * pixels / 8;                        // half a sample at each side of both squares
  EXPECT_NEAR(sum_of(render(square(0.7F, 0), view, 8)), std::pow(1.4 * pixels / 3, 2), tolerance);
  EXPECT_NEAR(sum_of(render(square(0.7F, 1), view, 8)), std::pow(1.4 * pixels / 2, 2), tolerance);
  view.projection = Projection::orthographic;
  EXPECT_NEAR(sum_of(render(square(0.7F, 1), view, 8)), std::pow(1.4 * pixels / 3, 2), tolerance);
  EXPECT_NEAR(sum_of(render(square(9, 0), view)), 120 * 80, 1e-9) << "cut off at the picture's border";
}

TEST(Rasteriser, UpAndRightAreUpAndRight) {
  TriangleMesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}, {0, 2, 3}}};
  const Image image = render(build_mesh(mesh), front_view());
  EXPECT_EQ(image.at(70, 30), 1);
  EXPECT_EQ(image.at(70, 50), 0);
  EXPECT_EQ(image.at(50, 30), 0);
}

TEST(Rasteriser, SphereIsADiscShadedByItsNormals) {
  View view = front_view();
  view.projection = Projection::orthographic;
  const double radius = 80 / (2 * std::tan(std::numbers::pi / 8)) / 3;
  // The mean of the cosine over the disc is 2/3.
  EXPECT_NEAR(sum_of(render(sphere(), view, 4)), 2.0 / 3 * std::numbers::pi * radius * radius, 3);
  view.lights = {{1, 0, 0}};
  const Image image = render(sphere(), view, 4);
  EXPECT_NEAR(image.at(60 + 10, 40), 10.5 / radius, 5e-3);
  EXPECT_EQ(image.at(60 - 10, 40), 0);
}

TEST(Rasteriser, SphereInPerspectiveIsTheDiscOfItsTangentCone) {
  View view = front_view();
  view.lights = {{0, 0, 1}, {1, 0, .1}, {-1, 0, .1}, {0, 1, .1}, {0, -1, .1}};  // white nearly everywhere
  const Image image = render(sphere(), view, 4);
  const auto covered = static_cast<double>(std::ranges::count_if(image.grey, [](float g) { return g > 0.5; }));
  const double radius = 80 / (2 * std::tan(std::numbers::pi / 8)) / std::sqrt(8.0);
  EXPECT_NEAR(covered, std::numbers::pi * radius * radius, 0.01 * covered);
}

TEST(Rasteriser, NearerFaceHidesFartherInAnyOrder) {
  View view = front_view();
  view.lights = {{0, 0, 1}};
  const float tilt = 1;  // the nearer square is tilted by 45 degrees from the light
  for (bool nearer_first : {true, false}) {
    TriangleMesh mesh;
    if (!nearer_first) add_square(mesh, 0.5F, 0);
    add_square(mesh, 0.2F, 1);
    for (size_t i = mesh.positions.size() - 4; i < mesh.positions.size(); ++i)
      mesh.positions[i].z += tilt * mesh.positions[i].x;
    if (nearer_first) add_square(mesh, 0.5F, 0);
    for (Projection projection : {Projection::perspective, Projection::orthographic}) {
      view.projection = projection;
      const Image image = render(build_mesh(mesh), view);
      EXPECT_NEAR(image.at(60, 40), std::sqrt(0.5), 1e-6);
      EXPECT_EQ(image.at(60, 40 + 12), 1);
    }
  }
}

TEST(Rasteriser, BackFacesAndFacesAcrossTheNearPlaneAreSkipped) {
  View view = front_view();
  EXPECT_GT(sum_of(render(square(0.5F, 2.5F), view)), 0);
  view.near = 1;
  EXPECT_EQ(sum_of(render(square(0.5F, 2.5F), view)), 0);
  EXPECT_EQ(sum_of(render(square(0.5F, 3.5F), view)), 0);
  view.eye = {0, 0, -3};
  view.lights = {{0, 0, 1}};
  EXPECT_EQ(sum_of(render(square(0.5F, 0), view)), 0);
}

TEST(Psnr, PsnrEqualsItsDefinition) {
  const Image black{2, 2, {0, 0, 0, 0}};
  EXPECT_EQ(psnr(black, black), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(psnr(black, {2, 2, {1, 1, 1, 1}}), 0, 1e-12);
  EXPECT_NEAR(psnr(black, {2, 2, {0, 0.1F, 0, 0}}), -10 * std::log10(0.01 / 4), 1e-6);
}

}  // namespace
}  // namespace papilio
