#include "papilio/view.h"

#include <gtest/gtest.h>

#include <random>

#include "core/criteria/camera.h"

namespace papilio {
namespace {

std::vector<Vec3d> corners(const Box& box) {
  std::vector<Vec3d> all;
  for (const float x : {box.min.x, box.max.x})
    for (const float y : {box.min.y, box.max.y})
      for (const float z : {box.min.z, box.max.z}) all.push_back({x, y, z});
  return all;
}

bool shows_all(const View& view, const Box& box) {
  const Camera camera(view);
  for (const Vec3d corner : corners(box))
    if (camera.is_outside(corner, 0)) return false;
  return true;
}

// A cube of side 2 in a field of view of 90 degrees: its front at z = 1 fills the picture at distance 1.
TEST(Framing, EyeOfACubeEqualsTheClosedForm) {
  const Box cube{{-1, -1, -1}, {1, 1, 1}};
  View view{.fov_y = 90, .viewport = {500, 500}};
  EXPECT_NEAR(framing_eye(view, cube).z, 2 * 1.05, 1e-12);
  view.viewport = {250, 500};  // half as wide: the width is the bound
  EXPECT_NEAR(framing_eye(view, cube).z, 3 * 1.05, 1e-12);
  view.near = 10;
  EXPECT_NEAR(framing_eye(view, cube).z, 3 * 1.05 + 10, 1e-12);
}

TEST(Framing, WholeBoxIsVisibleAndFillsThePicture) {
  std::mt19937 random(5);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  for (int round = 0; round < 2000; ++round) {
    const auto coordinate = [&] { return static_cast<float>(between(-10, 10)); };
    Box box{{coordinate(), coordinate(), coordinate()}, {}};
    const auto side = [&] { return static_cast<float>(between(0, 10)); };
    box.max = {box.min.x + side(), box.min.y + side(), box.min.z + side()};
    View view;
    view.target = box.centre();
    if (round % 3 == 0) view.target = view.target + Vec3d{between(-5, 5), between(-5, 5), between(-5, 5)};
    view.up = {between(-1, 1), between(-1, 1), round % 2 == 0 ? 0 : between(-1, 1)};
    if (round % 5 == 0) view.up = {0, 0, round % 10 == 0 ? 1.0 : -1.0};
    view.fov_y = between(1, 150);
    view.viewport = {between(100, 2000), between(100, 2000)};
    if (round % 4 == 0) view.near = between(0, 1);
    if (round % 7 == 0) view.projection = Projection::orthographic;
    view.eye = framing_eye(view, box);
    ASSERT_TRUE(shows_all(view, box)) << round;
    // A tenth nearer, part of the box is outside.
    view.near = 1e-9;
    view.eye = view.target + 0.9 * (view.eye - view.target);
    if (round % 4 != 0 && round % 3 != 0) {
      ASSERT_FALSE(shows_all(view, box)) << round;
    }
  }
}

TEST(Framing, ModelWithItsHeightAlongZIsSeenFromItsFront) {
  const Box box{{-1, -2, -3}, {1, 2, 3}};
  const View view{.up = {0, 0, 1}};
  const Vec3d eye = framing_eye(view, box);
  EXPECT_EQ(eye.x, 0);
  EXPECT_LT(eye.y, -2);
  EXPECT_EQ(eye.z, 0);
}

}  // namespace
}  // namespace papilio
