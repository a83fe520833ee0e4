#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <thread>

#include "papilio/detail.h"
#include "papilio/refine.h"
#include "tests/support/decoded_detail.h"
#include "tests/support/shapes.h"
#include "tests/support/streamed_detail.h"
#include "tests/support/two_sided_distance.h"

// Refinement of a base with detail: levels equal the decoder's, and adaptive results use their vertices.

namespace papilio {
namespace {

constexpr int levels_of_detail = 4;

/// Random residuals at all levels.
DetailSource rough_detail() {
  return test::detail_of_residuals(test::icosahedron(), levels_of_detail, 0.1F, [](int l, uint32_t e, Vec3f) {
    return static_cast<int32_t>((e * 2654435761U + static_cast<uint32_t>(l)) >> 16U) % 5 - 2;
  });
}

constexpr int levels_of_bump = 3;

/// A smooth surface with a bump at the highest x, only in its last level.
DetailSource detail_with_late_bump() {
  const TriangleMesh base = test::torus(40, 20);
  const float farthest = bounding_box(base.positions).max.x;
  return test::detail_of_residuals(base, levels_of_bump, 0.16F, [farthest](int l, uint32_t, Vec3f middle) {
    return l == levels_of_bump - 1 && middle.x > 0.98F * farthest ? 20 : 0;
  });
}

TriangleMesh decoded(const DetailSource& source, int levels) {
  return test::decoded_triangles(source.base, std::span(source.levels).first(static_cast<size_t>(levels)));
}
TriangleMesh decoded(const DetailSource& source) { return test::decoded_triangles(source.base, source.levels); }

double diagonal_of(const DetailSource& source) { return bounding_box(source.base.triangles.positions).diagonal(); }

using Corners = std::array<Vec3f, 3>;

std::vector<Corners> sorted_faces(const TriangleMesh& mesh) {
  std::vector<Corners> faces;
  for (const Triangle& t : mesh.triangles)
    faces.push_back({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
  const auto key = [](const Vec3f& p) { return std::tuple(p.x, p.y, p.z); };
  for (Corners& face : faces) std::ranges::rotate(face, std::ranges::min_element(face, {}, key));
  std::ranges::sort(faces, {}, [&](const Corners& f) { return std::tuple(key(f[0]), key(f[1]), key(f[2])); });
  return faces;
}

void expect_vertices_among(const Mesh& some, const TriangleMesh& all) {
  std::set<std::tuple<float, float, float>> places;
  for (const Vec3f& p : all.positions) places.emplace(p.x, p.y, p.z);
  for (const Vec3f& p : some.positions) ASSERT_TRUE(places.contains({p.x, p.y, p.z})) << p.x << ' ' << p.y;
}

Options view_options(double error_pixels) {
  Options options;
  options.levels = levels_of_detail;
  options.view = View{};
  options.view->eye = {5, 0, 0};
  options.view->target = {0, 0, 0};
  options.view->up = {0, 0, 1};
  options.view->error_pixels = error_pixels;
  options.view->edge_pixels = 0;
  return options;
}

TEST(DetailLevels, UniformLevelsEqualTheDecoders) {
  const DetailSource source = rough_detail();
  for (int levels = 0; levels <= levels_of_detail; ++levels)
    for (const bool edges : {false, true})
      for (const Tension tension : {Tension::off, Tension::soft}) {
        Options options;
        options.levels = levels;
        options.edges = edges;
        options.tension = tension;
        const Mesh mesh = refine(test::with_detail(source), options, {.threads = edges ? 2 : 1}).mesh;
        EXPECT_EQ(mesh.triangles(), decoded(source, levels)) << levels << edges;
        EXPECT_EQ(mesh.detail, nullptr);
      }
}

size_t count(const Mesh& mesh, EdgeKind kind) {
  return static_cast<size_t>(std::ranges::count(mesh.topology.kind, kind));
}

void expect_tolerance(const DetailSource& source, double tolerance) {
  const Mesh uniform = build_mesh(decoded(source));
  Options options;
  options.levels = static_cast<int>(source.levels.size());
  options.tolerance = tolerance;
  const Result result = refine(test::with_detail(source), options);
  const double distance = test::two_sided_distance(result.mesh, uniform).largest() / diagonal_of(source);
  EXPECT_LE(distance, tolerance);
  EXPECT_LE(distance, 1.001 * result.error);
  EXPECT_LT(result.mesh.topology.face_count(), uniform.topology.face_count());
  expect_vertices_among(result.mesh, uniform.triangles());
}

/// Encodes an original without a base coder.
DetailSource encoded(const TriangleMesh& original, double rms) {
  DetailOptions options;
  options.rms = rms;
  EncodedDetail made = encode_detail(original, options, [](const TriangleMesh& base, std::span<const Vec3d>) {
    return CodedBase{base, 1};
  });
  return {std::move(made.base), std::move(made.levels)};
}

TEST(DetailLevels, BoundariesAndCreasesEqualTheDecoders) {
  TriangleMesh sheet = test::grid(16, 16);
  for (Vec3f& p : sheet.positions) p.z = 2 * std::sin(0.3F * p.x) * std::cos(0.2F * p.y);
  for (const auto& [original, kind] :
       {std::pair(sheet, EdgeKind::boundary), std::pair(test::box({8, 8, 8}, {1, 2, 3}), EdgeKind::crease)}) {
    const DetailSource source = encoded(original, 2e-3);
    const auto levels = static_cast<int>(source.levels.size());
    ASSERT_GT(levels, 0);
    const size_t curves = count(test::with_detail(source), kind);
    EXPECT_GT(curves, 0U);
    Options options;
    for (options.levels = 0; options.levels <= levels; ++options.levels)
      EXPECT_EQ(refine(test::with_detail(source), options).mesh.triangles(), decoded(source, options.levels));
    EXPECT_EQ(count(refine(test::with_detail(source), options).mesh, kind), curves << options.levels);
    expect_tolerance(source, 0.005);
  }
}

TEST(DetailLevels, TinyToleranceGivesTheDecodersFinestLevel) {
  const DetailSource source = rough_detail();
  Options options;
  options.levels = levels_of_detail;
  options.tolerance = 1e-9;
  const Result result = refine(test::with_detail(source), options);
  EXPECT_EQ(sorted_faces(result.mesh.triangles()), sorted_faces(decoded(source)));
  EXPECT_EQ(result.error, 0);
}

TEST(DetailLevels, ReportedErrorIsWithinTheTolerance) {
  for (const double tolerance : {0.02, 0.004, 0.0008, 0.0001}) {
    Options options;
    options.levels = levels_of_detail;
    options.tolerance = tolerance;
    EXPECT_LE(refine(test::with_detail(rough_detail()), options).error, tolerance);
  }
}

TEST(DetailLevels, FurtherLevelsSubdivideTheFinestDecodedLevel) {
  const DetailSource source = rough_detail();
  for (const Tension tension : {Tension::off, Tension::soft}) {
    Options options;
    options.tension = tension;
    options.levels = levels_of_detail + 2;
    const Result fine = refine(test::with_detail(source), options);
    EXPECT_EQ(fine.shape, ShapeReport{});
    options.levels = 2;
    options.shape = Shape::plain;
    const Mesh expected = refine(build_mesh(decoded(source, levels_of_detail)), options).mesh;
    EXPECT_EQ(sorted_faces(fine.mesh.triangles()), sorted_faces(expected.triangles()));
  }
}

TEST(DetailLevels, ToleranceHoldsAgainstTheFinestLevel) {
  for (const double tolerance : {0.03, 0.01, 0.003, 0.001}) expect_tolerance(rough_detail(), tolerance);
}

TEST(DetailLevels, ToleranceHoldsWhereOnlyTheLastLevelMovesTheSurface) {
  for (const double tolerance : {0.02, 0.005}) expect_tolerance(detail_with_late_bump(), tolerance);
}

/// A torus whose new vertices are up to three quarters of its tube's radius away.
DetailSource detail_with_spikes(uint32_t seed) {
  return test::detail_of_residuals(test::torus(8, 6), 2, 0.15F, [seed](int l, uint32_t e, Vec3f) {
    return static_cast<int32_t>(((e + 977 * seed + 31 * static_cast<uint32_t>(l)) * 2654435761U) >> 16U) % 11 - 5;
  });
}

// A side of the finest level passes over a valley of the result, though both of its ends are near.
TEST(DetailLevels, ToleranceHoldsBetweenTheVerticesOfTheFinestLevel) {
  for (uint32_t seed = 0; seed < 20; ++seed)
    for (const double tolerance : {0.03, 0.02, 0.01}) {
      SCOPED_TRACE(std::to_string(seed) + " " + std::to_string(tolerance));
      expect_tolerance(detail_with_spikes(seed), tolerance);
    }
}

TEST(DetailLevels, ToleranceHoldsAgainstLevelsBelowTheDetail) {
  const DetailSource source = rough_detail();
  Options options;
  options.levels = levels_of_detail + 1;
  const Mesh uniform = refine(test::with_detail(source), options).mesh;
  options.tolerance = 0.003;
  const Result result = refine(test::with_detail(source), options);
  EXPECT_LE(test::two_sided_distance(result.mesh, uniform).largest() / diagonal_of(source), options.tolerance);
  expect_vertices_among(result.mesh, uniform.triangles());
}

TEST(DetailLevels, BudgetResultsUseTheDecodersVertices) {
  const DetailSource source = rough_detail();
  const Mesh uniform = build_mesh(decoded(source, levels_of_detail));
  double before = 1;
  for (const uint64_t faces : {100U, 400U, 1600U}) {
    Options options;
    options.levels = levels_of_detail;
    options.max_faces = faces;
    const Result result = refine(test::with_detail(source), options);
    EXPECT_LE(result.mesh.topology.face_count(), faces);
    EXPECT_GT(result.mesh.topology.face_count(), faces / 2);
    const double distance = test::two_sided_distance(result.mesh, uniform).rms;
    EXPECT_LT(distance, before);
    before = distance;
    expect_vertices_among(result.mesh, uniform.triangles());
  }
}

TEST(DetailLevels, FlatnessResultsUseTheDecodersVertices) {
  const DetailSource source = rough_detail();
  Options options;
  options.levels = levels_of_detail;
  options.flatness = {0.95};
  const Mesh mesh = refine(test::with_detail(source), options).mesh;
  EXPECT_GT(mesh.topology.face_count(), 100U);
  expect_vertices_among(mesh, decoded(source, levels_of_detail));
}

TEST(DetailLevels, ViewRefinesABumpBelowFlatFaces) {
  const DetailSource bump = detail_with_late_bump();
  const TriangleMesh all = decoded(bump);
  const auto highest = [](std::span<const Vec3f> positions) { return bounding_box(positions).max.x; };
  const Mesh mesh = refine(test::with_detail(bump), view_options(5)).mesh;
  EXPECT_EQ(highest(mesh.positions), highest(all.positions));
  EXPECT_LT(mesh.topology.face_count(), all.triangles.size() / 2);
  expect_vertices_among(mesh, all);
  Options from_behind = view_options(5);
  from_behind.view->eye = {-5, 0, 0};
  EXPECT_NE(highest(refine(test::with_detail(bump), from_behind).mesh.positions), highest(all.positions));
}

TEST(DetailLevels, LimitsHoldForDecodedLevels) {
  Options options = view_options(0);
  options.view->fov_y = 1;  // shows few faces
  options.face_limit = 20U << 6U;
  try {
    (void)refine(test::with_detail(rough_detail()), options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::result_too_large);
    EXPECT_NE(std::string(error.what()).find(std::to_string(20U << 8U)), std::string::npos);
  }
  options.stop_at_limits = true;
  const Result result = refine(test::with_detail(rough_detail()), options);
  EXPECT_EQ(result.stop_reason, StopReason::limits);
  EXPECT_EQ(result.levels, 3);
}

TEST(DetailLevels, ToleranceThatLimitsCannotVerifyIsRefused) {
  Options options;
  options.levels = levels_of_detail;
  options.tolerance = 0.05;
  options.stop_at_limits = true;
  options.face_limit = 20U << 6U;
  try {
    (void)refine(test::with_detail(rough_detail()), options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::result_too_large);
  }
  options.levels = 3;
  EXPECT_LE(refine(test::with_detail(rough_detail()), options).error, options.tolerance);
}

TEST(DetailLevels, PreparedMeshesGiveBitIdenticalResults) {
  const DetailSource source = rough_detail();
  for (const uint64_t budget : {uint64_t{0}, uint64_t{200'000}, uint64_t{100} << 20}) {
    const PreparedMesh prepared(test::with_detail(source), {}, budget);
    for (int turn = 0; turn < 8; ++turn) {
      Options options = view_options(turn % 2 == 0 ? 0 : 2);
      options.view->eye = {5 * std::cos(0.7 * turn), 5 * std::sin(0.7 * turn), 1};
      options.view->fov_y = 20;
      options.levels = levels_of_detail + turn % 2;
      EXPECT_EQ(refine(prepared, options).mesh.triangles(),
                refine(test::with_detail(source), options).mesh.triangles());
    }
  }
}

TEST(DetailLevels, ConcurrentRequestsShareOneDetail) {
  const DetailSource source = rough_detail();
  const Mesh mesh = test::with_detail(source);
  std::vector<std::thread> threads;
  std::vector<TriangleMesh> made(levels_of_detail + 1);
  for (int levels = 0; levels <= levels_of_detail; ++levels)
    threads.emplace_back([&, levels] {
      Options options;
      options.levels = levels;
      made[static_cast<size_t>(levels)] = refine(mesh, options).mesh.triangles();
    });
  for (std::thread& thread : threads) thread.join();
  for (int levels = 0; levels <= levels_of_detail; ++levels)
    EXPECT_EQ(made[static_cast<size_t>(levels)], decoded(source, levels));
}

TEST(DetailLevels, CancelledDecodingCanBeResumed) {
  const DetailSource source = rough_detail();
  const auto detail = stream_detail(source);
  int asked = 0;
  EXPECT_THROW((void)detail->new_vertices(3, [&] { return ++asked > 2; }), Error);
  const TriangleMesh all = decoded(source, levels_of_detail);
  EXPECT_TRUE(
      std::ranges::equal(detail->new_vertices(3), std::span(all.positions).last(detail->new_vertices(3).size())));
}

TEST(DetailLevels, DamagedDetailIsRefusedEveryTime) {
  DetailSource source = rough_detail();
  source.levels[1].step = 1e18F;
  source.levels[1].bytes.assign(40, 0xAA);
  const auto detail = stream_detail(source);
  EXPECT_EQ(detail->new_vertices(0).size(), 30U);
  for (int i = 0; i < 2; ++i) EXPECT_THROW((void)detail->new_vertices(1), Error);
  EXPECT_EQ(detail->new_vertices(0).size(), 30U);
}

TEST(DetailLevels, LargestMoveBoundsTheDistanceOfALevel) {
  const DetailSource source = detail_with_late_bump();
  const auto detail = stream_detail(source);
  const double move = detail->largest_move(levels_of_bump - 1);
  const Mesh before = build_mesh(decoded(source, levels_of_bump - 1));
  const test::TwoSidedDistance distance = test::two_sided_distance(before, build_mesh(decoded(source)));
  EXPECT_LE(distance.largest(), move);
  EXPECT_GT(distance.largest(), 0.9 * move);
  EXPECT_LT(detail->largest_move(levels_of_bump - 2), move / 10);
}

TEST(DetailLevels, DetailOfAnotherMeshIsRefused) {
  Mesh mesh = build_mesh(test::torus(6, 6));
  EXPECT_THROW(mesh.attach_detail(stream_detail(rough_detail())), Error);
  EXPECT_EQ(mesh.detail, nullptr);
  TriangleMesh turned = test::icosahedron();
  std::ranges::rotate(turned.triangles, turned.triangles.begin() + 1);
  Mesh other_order = build_mesh(turned);
  EXPECT_THROW(other_order.attach_detail(stream_detail(rough_detail())), Error);
}

TEST(DetailLevels, InPlaceSchemeIsRefusedWhateverTheCriteria) {
  for (const int levels : {0, 2})
    for (const double tolerance : {0.0, 0.01}) {
      const Options options{.levels = levels, .scheme = Scheme::in_place, .tolerance = tolerance};
      try {
        (void)refine(test::with_detail(rough_detail()), options);
        FAIL() << levels << " " << tolerance;
      } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::bad_option);
        EXPECT_EQ(error.option(), "scheme");
      }
    }
}

}  // namespace
}  // namespace papilio
