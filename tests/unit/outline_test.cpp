#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/criteria/camera.h"
#include "papilio/refine.h"
#include "tests/support/rasteriser.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"

// Outlines in views without an error target: they are below back faces.

namespace papilio {
namespace {

using namespace test;

/// Returns the extent of a mesh in the picture in each of 360 directions, in pixels: the outline if convex.
std::vector<double> reach(const Mesh& mesh, const View& view) {
  constexpr size_t directions = 360;
  const Camera camera(view);
  const Vec3d forward = 1 / length(view.target - view.eye) * (view.target - view.eye);
  const Vec3d sideways = cross(forward, view.up);
  const Vec3d right = 1 / length(sideways) * sideways;
  const Vec3d up = cross(right, forward);
  std::vector<double> most(directions, 0);
  for (const Vec3f& p : mesh.positions) {
    const Vec3d at = to_double(p);
    const Vec3d seen = camera.pixels_per_unit(at) * (at - view.eye);
    for (size_t i = 0; i < directions; ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / directions;
      most[i] = std::max(most[i], std::cos(angle) * dot(seen, right) + std::sin(angle) * dot(seen, up));
    }
  }
  return most;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

TEST(Outline, SphereHasARoundOutlineAtAnyEdgeLength) {
  Mesh sphere = build_mesh(icosahedron());
  sphere = refine(sphere, {.levels = 1}).mesh;
  for (Vec3f& p : sphere.positions) p = 1 / length(p) * p;
  const View view{.eye = {0.3, 0.2, 3.5}};
  const std::vector<double> wanted = reach(refine(sphere, {.levels = 6}).mesh, view);
  EXPECT_GT(largest_difference(reach(sphere, view), wanted), 5);
  for (const double edge_pixels : {0.0, 10.0}) {
    Options options{.levels = 6, .view = view};
    options.view->edge_pixels = edge_pixels;
    const Mesh refined = refine(sphere, options).mesh;
    EXPECT_LT(largest_difference(reach(refined, view), wanted), 0.5) << edge_pixels;
    EXPECT_LT(refined.topology.face_count(), edge_pixels > 0 ? 20'000U : 130'000U);
  }
}

TEST(Outline, FlatnessOutlineEqualsTheResultWithoutAView) {
  Mesh sphere = refine(build_mesh(icosahedron()), {.levels = 1}).mesh;
  for (Vec3f& p : sphere.positions) p = 1 / length(p) * p;
  const View view{.eye = {0.3, 0.2, 3.5}};
  for (const double flatness : {0.999, 0.9999})
    for (const double edge_pixels : {0.0, 10.0}) {
      Options options{.levels = 6, .flatness = {flatness}};
      const Mesh everywhere = refine(sphere, options).mesh;
      options.view = view;
      options.view->edge_pixels = edge_pixels;
      const Mesh refined = refine(sphere, options).mesh;
      EXPECT_LT(largest_difference(reach(refined, view), reach(everywhere, view)), 0.25) << flatness << edge_pixels;
      EXPECT_LT(refined.topology.face_count(), everywhere.topology.face_count() / 2) << flatness << edge_pixels;
    }
}

/// Returns the share of pixels that only one of two pictures covers.
double share_apart(const Image& a, const Image& b) {
  size_t apart = 0;
  for (size_t i = 0; i < a.grey.size(); ++i) apart += (a.grey[i] > 0) != (b.grey[i] > 0) ? 1 : 0;
  return static_cast<double>(apart) / static_cast<double>(a.grey.size());
}

TEST(Outline, RealMeshHasTheUniformResultsOutline) {
  const Mesh bunny = build_mesh(real_mesh("bunny600.obj"));
  const Box box = bounding_box(bunny.positions);
  const Vec3d middle = 0.5 * (to_double(box.min) + to_double(box.max));
  const Mesh uniform = refine(bunny, {.levels = 4}).mesh;
  for (int side = 0; side < 6; ++side) {
    const double angle = side * std::numbers::pi / 3;
    View view{.eye = middle + 1.3 * box.diagonal() * Vec3d{std::sin(angle), 0.3, std::cos(angle)}, .target = middle};
    view.viewport = {400, 400};
    view.edge_pixels = 2;
    view.lights = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};  // from all directions
    const Image wanted = render(uniform, view);
    Options options{.levels = 4, .view = view};
    options.view->lights.clear();
    const Mesh refined = refine(bunny, options).mesh;
    EXPECT_GT(share_apart(render(bunny, view), wanted), 2e-3) << side;
    EXPECT_LT(share_apart(render(refined, view), wanted), 2e-4) << side;
    EXPECT_LT(refined.topology.face_count(), uniform.topology.face_count() / 2) << side;
  }
}

}  // namespace
}  // namespace papilio
