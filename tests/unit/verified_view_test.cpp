#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <span>

#include "papilio/refine.h"
#include "tests/support/random_request.h"
#include "tests/support/real_mesh.h"
#include "tests/support/seen_distance.h"
#include "tests/support/shapes.h"

// view.error_pixels bounds the visible distance between the result and the uniform result of equal levels. Measured
// with a tree of boxes (seen_distance.h), independent of levels.

namespace papilio {
namespace {

using namespace test;

Vec3d centre_of(const Box& box) { return 0.5 * (to_double(box.min) + to_double(box.max)); }

/// Returns a view from a random side, in which the mesh fills the picture or is partly outside.
View random_view(std::mt19937& random, const Box& box) {
  std::normal_distribution<double> direction;
  Vec3d towards{direction(random), direction(random), direction(random)};
  towards = 1 / length(towards) * towards;
  const double distance = std::uniform_real_distribution<double>(0.8, 2)(random);
  const Vec3d centre = centre_of(box);
  return {.eye = centre + distance * box.diagonal() * towards,
          .target = centre,
          .up = std::abs(towards.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0},
          .viewport = {800, 600},
          .edge_pixels = 0};
}

struct Measured {
  Result result;
  SeenDistance distance;
};

Measured measure(const Mesh& coarse, const Options& options) {
  Measured measured{.result = refine(coarse, options), .distance = {}};
  Options all = options;
  all.view.reset();
  measured.distance = seen_distance(measured.result.mesh, refine(coarse, all).mesh, *options.view);
  return measured;
}

void expect_kept(const Mesh& coarse, Options options, double pixels) {
  SCOPED_TRACE(std::to_string(pixels) + " pixels");
  constexpr double sampling = 1.25;  // distances may be larger between the points that the core compares
  options.view->error_pixels = pixels;
  const auto [result, distance] = measure(coarse, options);
  EXPECT_LE(distance.largest(), sampling * pixels) << result.mesh.topology.face_count() << " faces";
  EXPECT_LE(distance.largest(), sampling * result.error_pixels + 1e-3);
  if (result.stop_reason == StopReason::converged) {
    EXPECT_LE(result.error_pixels, pixels);
  }
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int seen_meshes = 1, views = 1;  // more take minutes
#else
constexpr int seen_meshes = 3, views = 3;
#endif

TEST(VerifiedView, PixelErrorHoldsForRealMeshesInBothDirections) {
  std::mt19937 random(1);
  constexpr std::array<std::pair<const char*, int>, 3> meshes{
      {{"bunny600.obj", 4}, {"elephant2000.obj", 3}, {"cgal/joint.off", 4}}};
  for (const auto& [name, levels] : std::span(meshes).first(seen_meshes)) {
    SCOPED_TRACE(name);
    const Mesh coarse = build_mesh(real_mesh(name));
    for (int i = 0; i < views; ++i) {
      const View view = random_view(random, bounding_box(coarse.positions));
      for (double pixels : {0.5, 1.0, 2.0, 4.0}) expect_kept(coarse, {.levels = levels, .view = view}, pixels);
    }
  }
}

TEST(VerifiedView, PixelErrorHoldsForRandomMeshes) {
  std::mt19937 random(2);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const Mesh coarse = build_mesh(random_small_mesh(random));
    Options options{.levels = 3};
    choose_rules(random, options);
    options.view = random_view(random, bounding_box(coarse.positions));
    expect_kept(coarse, options, std::pow(10, 1 - 1.5 * i / 60));
  }
}

TEST(VerifiedView, VerificationAddsLessThanTwiceTheFaces) {
  const Mesh coarse = build_mesh(real_mesh("bunny600.obj"));
  const Box box = bounding_box(coarse.positions);
  Options options{.levels = 4, .view = View{.target = centre_of(box), .edge_pixels = 0, .error_pixels = 1}};
  options.view->eye = framing_eye(*options.view, box);
  const Result verified = refine(coarse, options);
  options.view->verify = false;
  const Result not_verified = refine(coarse, options);
  EXPECT_GT(verified.mesh.topology.face_count(), not_verified.mesh.topology.face_count());
  EXPECT_LT(verified.mesh.topology.face_count(), 2 * not_verified.mesh.topology.face_count());
}

/// A bumpy sheet and its reverse, seen from above.
TEST(VerifiedView, TwoSidedViewRefinesBacksLikeFronts) {
  TriangleMesh sheet = grid(12, 12);
  for (Vec3f& p : sheet.positions) p.z = 0.4F * std::sin(0.9F * p.x) * std::cos(0.8F * p.y);
  TriangleMesh turned = sheet;
  for (Triangle& t : turned.triangles) std::swap(t[1], t[2]);
  const Mesh front = build_mesh(sheet);
  const Mesh back = build_mesh(turned);
  for (const bool is_verified : {true, false})
    for (const std::vector<Vec3d>& lights : {std::vector<Vec3d>{}, std::vector<Vec3d>{{0, 0, 1}}}) {
      Options options{.levels = 4, .shape = Shape::plain};
      options.view = View{.eye = {6, 6, 12}, .target = {6, 6, 0}, .viewport = {800, 600}, .edge_pixels = 0};
      options.view->error_pixels = 0.5;
      options.view->verify = is_verified;
      options.view->lights = lights;
      const uint32_t seen = refine(front, options).mesh.topology.face_count();
      const uint32_t from_behind = refine(back, options).mesh.topology.face_count();
      options.view->two_sided = true;
      const Result two_sided = refine(back, options);
      EXPECT_LT(2 * from_behind, seen);
      // Rounding differs between the two sheets, and with it which of two equal edges is split.
      EXPECT_NEAR(two_sided.mesh.topology.face_count(), seen, 2);
      EXPECT_EQ(refine(front, options).mesh.topology.face_count(), seen);
      if (is_verified && lights.empty()) expect_kept(back, options, 0.5);
    }
}

TEST(VerifiedView, PixelErrorHoldsInsideSeenThroughHoles) {
  const Mesh elephant = build_mesh(real_mesh("cgal/elephant-with-holes.off"));
  std::mt19937 random(31);
  Options options{.levels = 2, .view = random_view(random, bounding_box(elephant.positions))};
  options.view->two_sided = true;
  for (const double pixels : {0.5, 2.0}) expect_kept(elephant, options, pixels);
}

}  // namespace
}  // namespace papilio
