#include "tests/support/reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "criteria/camera.h"
#include "tests/support/decisive_request.h"
#include "tests/support/seen_distance.h"
#include "tests/support/shapes.h"
#include "tests/support/small_surfaces.h"
#include "tests/support/two_sided_distance.h"

// The core compared with the reference implementation, which is in double precision.

namespace papilio::test {
namespace {

/// Tolerances as shares of the largest coordinate: errors of 6e-8 in single precision add up over levels and sums.
constexpr double enough_margin = 5e-6, position_rounding = 4e-6;

constexpr uint64_t most_faces = 1500;  ///< of a uniform result

using Faces = std::multiset<Triangle>;

void insert_from_lowest(Triangle face, Faces& faces) {
  std::ranges::rotate(face, std::ranges::min_element(face));
  faces.insert(face);
}

Faces faces_of(const Mesh& mesh) {
  Faces faces;
  for (const Triangle& t : mesh.triangles().triangles) insert_from_lowest(t, faces);
  return faces;
}

/// Lookup of the vertices of a mesh by position.
class VertexFinder {
 public:
  explicit VertexFinder(const Mesh& mesh) : mesh_(mesh) {
    for (uint32_t v = 0; v < mesh.positions.size(); ++v) by_x_.emplace(mesh.positions[v].x, v);
  }
  /// Returns the nearest vertex within a distance; V if there is none.
  [[nodiscard]] uint32_t find(Vec3d p, double most) const {
    auto nearest = static_cast<uint32_t>(mesh_.positions.size());
    for (auto at = by_x_.lower_bound(p.x - most); at != by_x_.end() && at->first <= p.x + most; ++at) {
      const double distance = length(to_double(mesh_.positions[at->second]) - p);
      if (distance > most) continue;
      nearest = at->second;
      most = distance;
    }
    return nearest;
  }

 private:
  const Mesh& mesh_;
  std::multimap<double, uint32_t> by_x_;
};

std::string text_of(const Options& options) {
  std::string text = "levels " + std::to_string(options.levels);
  if (options.scheme == Scheme::in_place) text += " in-place";
  for (double threshold : options.flatness) text += " flatness " + std::to_string(threshold);
  text += " growth " + std::to_string(static_cast<int>(options.growth));
  text += " tension " + std::to_string(static_cast<int>(options.tension));
  text += " w " + std::to_string(options.w) + " crease_angle " + std::to_string(options.crease_angle);
  text += " tolerance " + std::to_string(options.tolerance) + " max_faces " + std::to_string(options.max_faces);
  if (!options.view) return text;
  const View& view = *options.view;
  text += view.projection == Projection::perspective ? " perspective" : " orthographic";
  text += " edge_pixels " + std::to_string(view.edge_pixels) + " error_pixels " + std::to_string(view.error_pixels);
  return text + " near " + std::to_string(view.near) + " lights " + std::to_string(view.lights.size());
}

double rounding_in(const Box& box) { return position_rounding * box.largest_coordinate(); }

/// Returns whether the mesh has the faces of the reference, with corners equal up to rounding.
bool has_faces(const Mesh& mesh, const reference::Outcome& expected, const Box& box) {
  const VertexFinder vertices(mesh);
  const auto find = [&](Vec3d p) { return vertices.find(p, rounding_in(box)); };
  Faces faces;
  for (const auto& [a, b, c] : expected.triangles) insert_from_lowest({find(a), find(b), find(c)}, faces);
  return mesh.topology.face_count() == expected.triangles.size() && faces_of(mesh) == faces;
}

/// Returns whether the core splits more than the reference, until the result is within a tolerance.
bool is_repaired(const Options& options) {
  return options.scheme == Scheme::red_green && !options.view && options.flatness.empty() &&
         (options.tolerance > 0 || options.max_faces > 0);
}

/// Returns whether the core splits more than the reference, until the visible result is within the pixel error.
bool is_verified(const Options& options) {
  return options.scheme == Scheme::red_green && options.view && options.flatness.empty() &&
         options.view->error_pixels > 0 && options.view->edge_pixels == 0 && options.view->lights.empty();
}

/// Returns whether the mesh has the vertices of the reference up to rounding.
bool has_vertices(const Mesh& mesh, const reference::Outcome& expected, const Box& box) {
  const VertexFinder vertices(mesh);
  for (const auto& triangle : expected.triangles)
    for (Vec3d p : triangle)
      if (vertices.find(p, rounding_in(box)) == mesh.positions.size()) return false;
  return true;
}

/// Checks a result with a tolerance: the repair starts from the reference's splits, and its distance is measured.
void expect_repaired(const Result& result, const Mesh& coarse, const Options& options,
                     const reference::Outcome& expected) {
  const Box box = bounding_box(coarse.positions);
  Options uniform = options;
  uniform.tolerance = 0;
  uniform.max_faces = 0;
  const double distance = two_sided_distance(result.mesh, papilio::refine(coarse, uniform).mesh).largest();
  constexpr double sampling = 1.03;
  EXPECT_LE(distance, sampling * result.error * box.diagonal() + rounding_in(box));
  if (options.max_faces > 0) {
    EXPECT_LE(result.mesh.topology.face_count(), options.max_faces);
    return;
  }
  EXPECT_GE(result.mesh.topology.face_count(), expected.triangles.size());
  EXPECT_TRUE(has_vertices(result.mesh, expected, box));
  EXPECT_LE(distance, sampling * options.tolerance * box.diagonal() + rounding_in(box));
}

/// Measures the distance of a verified result.
void expect_verified(const Mesh& coarse, const Options& options) {
  const Result result = papilio::refine(coarse, options);
  Options uniform = options;
  uniform.tolerance = 0;
  uniform.max_faces = 0;
  uniform.view.reset();
  const double pixels = seen_distance(result.mesh, papilio::refine(coarse, uniform).mesh, *options.view).largest();
  constexpr double sampling = 1.25;
  const Box box = bounding_box(coarse.positions);
  const double rounding = rounding_in(box) * Camera(*options.view).highest_pixels_per_unit(box);
  if (options.tolerance == 0) {
    EXPECT_LE(pixels, sampling * result.error_pixels + rounding);
  }
  if (options.max_faces > 0) {
    EXPECT_LE(result.mesh.topology.face_count(), options.max_faces);
  } else if (options.tolerance == 0) {
    EXPECT_LE(pixels, sampling * options.view->error_pixels + rounding);
  }
}

void expect_same(const Result& result, const reference::Outcome& expected, const Box& box) {
  const double rounding = rounding_in(box);
  EXPECT_TRUE(has_faces(result.mesh, expected, box))
      << result.mesh.topology.face_count() << " faces, expected " << expected.triangles.size();
  EXPECT_EQ(result.levels, expected.levels);
  EXPECT_EQ(result.stop_reason, expected.stop_reason);
  constexpr double share = 1e-4;
  EXPECT_NEAR(result.error, expected.error, share * expected.error + rounding / box.diagonal());
  EXPECT_NEAR(result.error_pixels, expected.error_pixels,
              share * expected.error_pixels + rounding * expected.pixels_per_unit);
}

/// Compares requests and counts them.
class Comparison {
 public:
  void compare(const Mesh& mesh, const Options& options) {
    Options by_error = options;
    constexpr double share_chosen_by_error = 0.88;  // of the tolerance, in the core
    if (is_repaired(options)) by_error.tolerance *= share_chosen_by_error;
    const reference::Outcome expected = reference::refine(mesh, by_error);
    ++requests_;
    if (expected.is_disputed || !(expected.margin >= enough_margin)) return;
    SCOPED_TRACE(text_of(options));
    Options chosen = options;
    if (is_verified(options)) {
      expect_verified(mesh, options);
      chosen.view->verify = false;
    }
    const Result result = papilio::refine(mesh, chosen);
    if (is_repaired(options))
      expect_repaired(result, mesh, options, expected);
    else
      expect_same(result, expected, bounding_box(mesh.positions));
    ++compared_;
    const uint64_t faces = mesh.topology.face_count();
    const uint64_t made = expected.triangles.size();
    in_part_ += made > faces && made < faces << 2U * options.levels ? 1 : 0;
  }
  /// Expects that two thirds of the requests are decisive in single precision and that many refine part of the mesh.
  void expect_enough() const {
    EXPECT_GT(3 * compared_, 2 * requests_) << compared_ << " of " << requests_;
    EXPECT_GT(4 * in_part_, compared_) << in_part_ << " of " << compared_;
  }

 private:
  int requests_ = 0, compared_ = 0, in_part_ = 0;
};

/// Compares some requests for each mesh.
void compare_all(std::mt19937& random, const std::vector<TriangleMesh>& meshes, int requests) {
  Comparison comparison;
  for (const TriangleMesh& triangles : meshes) {
    const Mesh mesh = build_mesh(triangles);
    SCOPED_TRACE("mesh " + std::to_string(&triangles - meshes.data()));
    for (int i = 0; i < requests; ++i) comparison.compare(mesh, decisive_request(random, mesh, most_faces));
    if (testing::Test::HasFailure()) return;
  }
  comparison.expect_enough();
}

std::vector<TriangleMesh> jittered_meshes(std::mt19937& random, int count) {
  std::vector<TriangleMesh> meshes;
  for (int i = 0; i < count; ++i) meshes.push_back(jittered_mesh(random));
  return meshes;
}

TEST(Reference, RandomMeshesAreEqual) {
  std::mt19937 random(1);
  compare_all(random, jittered_meshes(random, 700), 4);
}

TEST(Reference, OtherRandomMeshesAreEqual) {
  std::mt19937 random(2);
  compare_all(random, jittered_meshes(random, 700), 4);
}

TEST(Reference, SmallSurfacesWithHolesAndPinchedVerticesAreEqual) {
  std::mt19937 random(3);
  compare_all(random, small_surfaces(5), 30);
}

/// Three sheets that share an edge.
TriangleMesh book() {
  return {{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {1, 0, 0}, {1, 0, 2}, {0, 1, 1}, {-1, -1, 1}},
          {{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {0, 1, 5}, {1, 2, 5}, {1, 0, 6}, {2, 1, 6}}};
}

/// Two octahedra that touch at a vertex.
TriangleMesh pinched() { return join(octahedron(), octahedron(), 2); }

TEST(Reference, FixedMeshesAreEqual) {
  std::mt19937 random(4);
  std::vector<TriangleMesh> meshes;
  for (const TriangleMesh& mesh : {icosahedron(), grid(4, 3), box({1, 2, 1}, {1, 2, 1}), book(), pinched()})
    for (double share : {0.01, 0.02, 0.03, 0.04}) {
      meshes.push_back(mesh);
      // Moved by a function of the position, so that equal points stay equal.
      for (Vec3f& p : meshes.back().positions)
        p += to_float(share * Vec3d{std::sin(7 * p.y + 3 * p.z), std::sin(5 * p.z + 2 * p.x), std::sin(6 * p.x + p.y)});
    }
  compare_all(random, meshes, 40);
}

// Known faults of the core. Each test fails once its fault is fixed. Then expect agreement and remove its case from
// `Outcome::is_disputed`.

/// Returns the number of a point of a grid.
uint32_t point_at(const TriangleMesh& mesh, float x, float y) {
  const auto is_there = [&](Vec3f p) { return p.x == x && p.y == y; };
  return static_cast<uint32_t>(std::ranges::find_if(mesh.positions, is_there) - mesh.positions.begin());
}

/// Sheet with a fold of 70 degrees from its rim to the vertex (3, 3), which has six faces.
TriangleMesh sheet_of_two_folds() {
  TriangleMesh mesh = grid(6, 6);
  for (Vec3f& p : mesh.positions) {
    const float depth = 0.7F * std::min(1.0F, std::abs(p.y - 3)) * std::clamp(p.x - 2, 0.0F, 1.0F);
    p.z = depth + 0.05F * std::sin(2 * p.x + p.y);
  }
  return mesh;
}

void expect_known_difference(const TriangleMesh& triangles, const Options& options) {
  const Mesh mesh = build_mesh(triangles);
  const reference::Outcome expected = reference::refine(mesh, options);
  ASSERT_GT(expected.margin, enough_margin);
  EXPECT_TRUE(expected.is_disputed);
  EXPECT_FALSE(has_faces(papilio::refine(mesh, options).mesh, expected, bounding_box(mesh.positions)));
}

TEST(Reference, CoreUsesTheKRuleAtADartOfSixFaces) {
  expect_known_difference(sheet_of_two_folds(), {.levels = 1, .tension = Tension::off, .crease_angle = 55});
}

TEST(Reference, CoreFindsNoDartAtAPinchedVertex) {
  TriangleMesh mesh = sheet_of_two_folds();
  // After the flip of the edge from (3, 3) to (2, 2) the fold ends at (2, 3), which has seven faces.
  const uint32_t a = point_at(mesh, 3, 3);
  const uint32_t b = point_at(mesh, 2, 2);
  const uint32_t end = point_at(mesh, 2, 3);
  erase_if(mesh.triangles,
           [&](const Triangle& t) { return std::ranges::count(t, a) == 1 && std::ranges::count(t, b) == 1; });
  mesh.triangles.push_back({b, point_at(mesh, 3, 2), end});
  mesh.triangles.push_back({a, end, point_at(mesh, 3, 2)});
  // A face that touches the sheet only at this vertex.
  const auto points = static_cast<uint32_t>(mesh.positions.size());
  mesh.positions.push_back({2, 3, 5});
  mesh.positions.push_back({1, 3, 5});
  mesh.triangles.push_back({end, points, points + 1});
  expect_known_difference(mesh, {.levels = 1, .tension = Tension::off, .crease_angle = 55});
}

TEST(Reference, CoreKeepsASliverAcrossASharedEdge) {
  // Two faces of opposite winding: dividing one splits their edge and makes slivers of the other.
  const TriangleMesh mesh{
      {{1.75F, 0.5F, 0.75F}, {2.875F, 0.125F, 0}, {1.625F, 2.75F, 1.625F}, {-0.125F, -0.875F, 0.125F}},
      {{0, 1, 2}, {2, 0, 3}}};
  expect_known_difference(mesh, {.levels = 2, .tolerance = 0.006});
}

}  // namespace
}  // namespace papilio::test
