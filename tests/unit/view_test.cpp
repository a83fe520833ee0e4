#include "core/criteria/view_culling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "core/criteria/camera.h"
#include "core/mesh/normals.h"
#include "core/split/split_in_four.h"
#include "papilio/error.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

View looking_down_z() {
  View view;
  view.eye = {0, 0, 10};
  view.viewport = {1000, 500};
  view.fov_y = 90;
  view.near = 1;
  return view;
}

std::string refused_option(const View& view) {
  try {
    const Camera camera(view);
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::bad_option);
    return error.option();
  }
  return "";
}

Marks seen(const Mesh& mesh, const View& view, double edge_pixels = 0) {
  const Camera camera(view);
  const Buffer<Vec3f> normals = face_normals(mesh);
  const Buffer<double> longest = longest_edges(mesh);
  const EdgesShown shown(mesh, normals, longest, camera, shared_half_edges(mesh.topology));
  Marks marks(mesh.topology.edge_count(), 0);
  for (uint32_t e = 0; e < marks.size(); ++e) marks[e] = shown[e] && is_long(mesh, camera, edge_pixels, e) ? 1 : 0;
  return marks;
}

size_t marked_count(const Marks& marks) { return static_cast<size_t>(std::count(marks.begin(), marks.end(), 1)); }

TEST(Camera, DegenerateViewsAreRefused) {
  View view = looking_down_z();
  EXPECT_EQ(refused_option(view), "");
  view.target = view.eye;
  EXPECT_EQ(refused_option(view), "view.target");
  view = looking_down_z();
  view.up = {0, 0, -3};
  EXPECT_EQ(refused_option(view), "view.up");
  view.up = {0, 0, 0};
  EXPECT_EQ(refused_option(view), "view.up");
  view = looking_down_z();
  view.fov_y = 180;
  EXPECT_EQ(refused_option(view), "view.fov_y");
  view = looking_down_z();
  view.viewport = {0, 100};
  EXPECT_EQ(refused_option(view), "view.viewport");
  view = looking_down_z();
  view.near = -1;
  EXPECT_EQ(refused_option(view), "view.near");
  view = looking_down_z();
  view.eye.x = std::nan("");
  EXPECT_EQ(refused_option(view), "view.eye");
}

TEST(Camera, FrustumHasTheViewportsAspectRatio) {
  const Camera camera(looking_down_z());  // at distance 10: 20 high, 40 wide
  EXPECT_FALSE(camera.is_outside({0, 9.9, 0}, 0));
  EXPECT_TRUE(camera.is_outside({0, 10.1, 0}, 0));
  EXPECT_FALSE(camera.is_outside({19.9, 0, 0}, 0));
  EXPECT_TRUE(camera.is_outside({-20.1, 0, 0}, 0));
  EXPECT_TRUE(camera.is_outside({0, 0, 9.5}, 0));   // in front of the near plane
  EXPECT_FALSE(camera.is_outside({0, 0, 9.5}, 1));  // inside with radius 1
  EXPECT_TRUE(camera.is_outside({0, 0, 20}, 1));    // behind the eye
}

TEST(Camera, OrthographicScaleEqualsPerspectiveAtTheTarget) {
  View view = looking_down_z();
  view.projection = Projection::orthographic;
  const Camera camera(view);
  for (double z : {0.0, 5.0, -50.0}) {
    EXPECT_FALSE(camera.is_outside({0, 9.9, z}, 0));
    EXPECT_TRUE(camera.is_outside({0, 10.1, z}, 0));
    EXPECT_NEAR(camera.projected_length({0, 0, z}, {1, 0, z}), 25, 1e-9);  // 500 pixels for 20 units
  }
  EXPECT_TRUE(camera.is_away({5, 5, 5}, {0, 0, -1}));
  EXPECT_FALSE(camera.is_away({5, 5, 5}, {0, 0, 1}));
}

TEST(Camera, ProjectedLengthIsClippedAtTheNearPlane) {
  const Camera camera(looking_down_z());
  EXPECT_NEAR(camera.projected_length({0, 0, 0}, {1, 0, 0}), 25, 1e-9);
  EXPECT_NEAR(camera.projected_length({0, 0, 5}, {0, 1, 5}), 50, 1e-9);
  EXPECT_NEAR(camera.projected_length({0, 0, 0}, {0, 0, 5}), 0, 1e-9);
  // Clipped at distance 1: from (1, 0) there, which is 250 pixels off the centre, to (0, 0).
  EXPECT_NEAR(camera.projected_length({0, 0, 0}, {1.8, 0, 18}), 250 * 0.9, 1e-9);
  EXPECT_EQ(camera.projected_length({0, 0, 9.5}, {3, 0, 12}), 0);  // entirely in front of the near plane
}

TEST(Camera, BackFacingDependsOnPositionInPerspective) {
  const Camera camera(looking_down_z());
  // Tilted away from the view direction; front-facing off the axis.
  const Vec3d normal = (1 / std::sqrt(1.01)) * Vec3d{-1, 0, -0.1};
  EXPECT_TRUE(camera.is_away({0, 0, 0}, normal));
  EXPECT_FALSE(camera.is_away({5, 0, 0}, normal));
  EXPECT_FALSE(camera.is_away({0, 0, 0}, {1, 0, 0}));  // edge on
}

TEST(EdgesShown, FrontEdgesAndSilhouetteAreShown) {
  const Mesh mesh = build_mesh(cube());
  View view = looking_down_z();
  view.eye = {0.5, 0.5, 5};
  view.target = {0.5, 0.5, 0};
  const Marks marks = seen(mesh, view);
  EXPECT_EQ(marked_count(marks), 5U);  // the front's four edges, which are the silhouette, and its diagonal
  for (uint32_t e = 0; e < marks.size(); ++e) {
    const uint32_t h = mesh.topology.half_edge[e];
    const bool front = mesh.positions[mesh.topology.origin[h]].z == 1 && mesh.positions[mesh.topology.tip(h)].z == 1;
    EXPECT_EQ(marks[e] != 0, front);
  }
}

TEST(EdgesShown, TwoSidedViewShowsAllEdgesInside) {
  const Mesh mesh = build_mesh(cube());
  View view = looking_down_z();
  view.eye = {0.5, 0.5, 5};
  view.target = {0.5, 0.5, 0};
  view.two_sided = true;
  EXPECT_EQ(marked_count(seen(mesh, view)), mesh.topology.edge_count());
}

TEST(EdgesShown, EdgesOutsideTheFrustumAreDropped) {
  const Mesh mesh = build_mesh(grid(40, 40));  // edges of length 1 to sqrt 2, in z = 0
  View view = looking_down_z();
  view.eye = {20, 20, 5};
  view.target = {20, 20, 0};
  view.viewport = {500, 500};
  const Marks marks = seen(mesh, view);  // shows 15..25
  for (uint32_t e = 0; e < marks.size(); ++e) {
    const uint32_t h = mesh.topology.half_edge[e];
    const Vec3f a = mesh.positions[mesh.topology.origin[h]];
    const Vec3f b = mesh.positions[mesh.topology.tip(h)];
    const auto off = [](float from, float to) { return std::max(20 - std::max(from, to), std::min(from, to) - 20); };
    const float distance = std::max(off(a.x, b.x), off(a.y, b.y));
    if (distance <= 5) {
      EXPECT_EQ(marks[e], 1);
    }
    if (distance > 9) {
      EXPECT_EQ(marks[e], 0);
    }
  }
}

TEST(EdgesShown, EdgesShorterThanTheThresholdAreDropped) {
  const Mesh mesh = build_mesh(grid(4, 4));
  View view = looking_down_z();  // 25 pixels a unit: edges of 25, diagonals of 35
  view.eye = {2, 2, 10};
  view.target = {2, 2, 0};
  EXPECT_EQ(marked_count(seen(mesh, view, 24)), mesh.topology.edge_count());
  EXPECT_EQ(marked_count(seen(mesh, view, 30)), 16U);
  EXPECT_EQ(marked_count(seen(mesh, view, 36)), 0U);
}

TEST(LongestEdges, LongestEdgesOfChildrenEqualThoseOfTheMesh) {
  std::mt19937 random(8);
  for (int i = 0; i < 20; ++i) {
    Mesh mesh = build_mesh(random_manifold(random));
    const Topology parents = std::exchange(mesh.topology, split_in_four(mesh.topology));
    mesh.positions.resize(mesh.topology.vertex_count);
    std::uniform_real_distribution<float> coordinate(-1, 1);
    for (Vec3f& p : mesh.positions) p = {coordinate(random), coordinate(random), coordinate(random)};
    EXPECT_EQ(longest_edges_below(parents, mesh.positions), longest_edges(mesh));
  }
}

TEST(Camera, FacingIsTheCosineToTheViewer) {
  View view;
  EXPECT_NEAR(Camera(view).facing({4, 0, 0}, {0, 0, 1}), 0.6, 1e-15);
  EXPECT_NEAR(Camera(view).facing({4, 0, 0}, {1, 0, 0}), -0.8, 1e-15);
  EXPECT_EQ(Camera(view).facing(view.eye, {0, 0, 1}), 0);
  view.projection = Projection::orthographic;
  EXPECT_EQ(Camera(view).facing({4, 0, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(Camera(view).facing({4, 0, 0}, {1, 0, 0}), 0);
}

TEST(EdgesShown, FaceWithoutAreaIsNeverBackFacing) {
  const Mesh mesh = build_mesh({{{0, 0, 0}, {2, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}});
  EXPECT_EQ(marked_count(seen(mesh, looking_down_z())), 3U);
}

}  // namespace
}  // namespace papilio
