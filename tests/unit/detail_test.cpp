#include "papilio/detail.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "core/detail/base_lift.h"
#include "core/detail/collapse_sequence.h"
#include "core/detail/placement.h"
#include "core/detail/residual_fit.h"
#include "core/detail/surface_distance.h"
#include "papilio/error.h"
#include "papilio/refine.h"
#include "server/sha256.h"
#include "tests/support/bumpy_sphere.h"
#include "tests/support/decoded_detail.h"
#include "tests/support/real_mesh.h"
#include "tests/support/sampled_distance.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

/// Returns the base unchanged, at nine bytes per vertex.
CodedBase keep_base(const TriangleMesh& base, std::span<const Vec3d> normals) {
  EXPECT_EQ(normals.size(), base.positions.size());
  return {base, 9 * base.positions.size()};
}

Fault fault_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.fault();
  }
  ADD_FAILURE() << "nothing was thrown";
  return Fault::cancelled;
}

void expect_reach(const TriangleMesh& original, const EncodedDetail& encoded, double wanted) {
  ASSERT_EQ(encoded.reach.size(), encoded.levels.size() + 1);
  EXPECT_LE(encoded.reach.back().rms, wanted);
  for (size_t levels = 1; levels < encoded.levels.size(); ++levels)
    EXPECT_GT(encoded.reach[levels].rms, wanted) << "level " << levels << " is enough";
  constexpr double rounding = 1e-8;  // of positions, as a share of the diagonal
  const test::SampledSurface surface(original, 40'000);
  const double diagonal = bounding_box(original.positions).diagonal();
  for (size_t levels = 0; levels < encoded.reach.size(); ++levels) {
    const TriangleMesh decoded = test::decoded_triangles(encoded.base, std::span(encoded.levels).first(levels));
    EXPECT_EQ(decoded.triangles.size(), encoded.base.triangles.triangles.size() << (2 * levels));
    const test::SampledDistance distance = surface.distance_to(decoded);
    const DetailReach& stated = encoded.reach[levels];
    EXPECT_NEAR(distance.rms / 100, stated.rms, 0.05 * stated.rms + rounding) << levels;
    EXPECT_NEAR(distance.largest / 100, stated.largest, 0.5 * stated.largest + rounding) << levels;
    const double of_vertices = vertex_distance(SurfaceTree(original), SurfaceTree(decoded)) / diagonal;
    EXPECT_LE(of_vertices, stated.largest + rounding) << levels;
  }
}

TEST(Detail, SmoothSurfaceHasTheStatedDistance) {
  for (const TriangleMesh& original : {test::bumpy_sphere(4), test::torus(60, 30)}) {
    DetailOptions options;
    options.rms = 1e-3;
    const EncodedDetail encoded = encode_detail(original, options, keep_base);
    expect_reach(original, encoded, options.rms);
    EXPECT_LT(encoded.folds, original.triangles.size() / 200);
    uint64_t bytes = 9 * encoded.base.triangles.positions.size();
    for (const DetailStream& level : encoded.levels) bytes += level.bytes.size();
    EXPECT_EQ(bytes, encoded.bytes);
    EXPECT_LT(bytes, original.positions.size()) << "less than a byte per vertex";
  }
}

TEST(Detail, RealMeshHasTheStatedDistance) {
  const TriangleMesh original = build_mesh(test::real_mesh("cgal/elephant.off")).triangles();
  DetailOptions options;
  options.rms = 3e-3;
  expect_reach(original, encode_detail(original, options, keep_base), options.rms);
}

TEST(Detail, SharpEdgesHaveTheStatedDistance) {
  const TriangleMesh original = test::box({16, 16, 16}, {1, 2, 3});
  for (const double rms : {2e-3, 1e-4}) {
    const EncodedDetail encoded = encode_detail(original, {.rms = rms}, keep_base);
    expect_reach(original, encoded, rms);
    EXPECT_EQ(encoded.levels.size(), 1U) << "the base is the box";
  }
}

TEST(Detail, EncodingKeepsTheTopology) {
  const TriangleMesh original = test::join(test::bumpy_sphere(3), test::torus(30, 15), 4);
  DetailOptions options;
  options.rms = 4e-3;
  const EncodedDetail encoded = encode_detail(original, options, keep_base);
  const Mesh decoded = build_mesh(test::decoded_triangles(encoded.base, encoded.levels));
  EXPECT_EQ(decoded.topology.euler_characteristic(), 2);
  EXPECT_TRUE(std::ranges::all_of(decoded.topology.kind, [](EdgeKind kind) { return kind == EdgeKind::smooth; }));
}

TEST(Detail, EncodingIsDeterministic) {
  const TriangleMesh original = test::bumpy_sphere(3);
  DetailOptions options;
  options.rms = 4e-3;
  const EncodedDetail one = encode_detail(original, options, keep_base);
  const EncodedDetail two = encode_detail(original, options, keep_base);
  ASSERT_EQ(one.levels.size(), two.levels.size());
  for (size_t l = 0; l < one.levels.size(); ++l) EXPECT_EQ(one.levels[l].bytes, two.levels[l].bytes);
  EXPECT_EQ(test::decoded_triangles(one.base, one.levels), test::decoded_triangles(two.base, two.levels));
}

/// Positions of vertices do not depend on the number of later levels.
TEST(Detail, VerticesKeepTheirPositions) {
  const TriangleMesh original = test::bumpy_sphere(3);
  DetailOptions options;
  options.rms = 2e-3;
  const EncodedDetail encoded = encode_detail(original, options, keep_base);
  const TriangleMesh all = test::decoded_triangles(encoded.base, encoded.levels);
  for (size_t levels = 0; levels < encoded.levels.size(); ++levels) {
    const TriangleMesh some = test::decoded_triangles(encoded.base, std::span(encoded.levels).first(levels));
    for (size_t v = 0; v < some.positions.size(); ++v) ASSERT_EQ(some.positions[v], all.positions[v]);
  }
}

/// Residuals of a finely sampled sphere and torus shrink by at least 4 per level: the butterfly is of higher order than
/// midpoints.
TEST(Detail, ResidualsOfSmoothSurfacesShrink) {
  for (const TriangleMesh& triangles : {test::bumpy_sphere(6), test::torus(300, 150)}) {
    const OriginalSurface original(build_mesh(triangles));
    CollapseSequence sequence(original.mesh());
    sequence.collapse_to(400);
    const BaseMesh base = sequence.base();
    const LiftedBase lifted = lift_base(sequence, base, {.triangles = base.triangles}, original, 3, {});
    const PlacedLevels placed = place_on_original(original, lifted, 3, {.last = 1e-6F, .ratio = 1}, {});
    double before = 0;
    for (const Residuals& residuals : placed.residuals) {
      double sum = 0;
      for (const int32_t k : residuals.along_normal) sum += std::abs(k);
      const double mean = sum / static_cast<double>(residuals.along_normal.size());
      if (before > 0) {
        EXPECT_GT(before / mean, 4);
      }
      before = mean;
    }
  }
}

TEST(Detail, SavingBitsInvertsAlmostNoFaces) {
  const OriginalSurface original(build_mesh(test::real_mesh("cgal/elephant.off")));
  CollapseSequence sequence(original.mesh());
  sequence.collapse_to(400);
  const BaseMesh base = sequence.base();
  constexpr int levels = 3;
  const LiftedBase lifted = lift_base(sequence, base, {.triangles = base.triangles}, original, levels, {});
  const StepSchedule steps{.last = static_cast<float>(0.004 * original.diagonal())};
  ResidualFit fit(original, lifted.mesh.positions, place_on_original(original, lifted, levels, steps, {}), {});
  const TriangleMesh placed = fit.surface(levels);
  fit.improve(5 * levels, 2);
  const TriangleMesh improved = fit.surface(levels);
  const auto normal = [](const TriangleMesh& mesh, const Triangle& t) {
    return cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
  };
  EXPECT_NE(placed, improved);
  size_t turned = 0;
  for (const Triangle& t : placed.triangles) turned += dot(normal(placed, t), normal(improved, t)) < 0 ? 1 : 0;
  EXPECT_LE(turned, 2U) << "of " << placed.triangles.size();
}

TEST(Detail, AnyStreamsDecodeOrAreRefused) {
  std::mt19937 random(7);
  const std::array<TriangleMesh, 2> bases{test::icosahedron(), test::grid(3, 3)};
  for (size_t round = 0; round < 200; ++round) {
    const TriangleMesh& base = bases[round % 2];
    std::vector<uint8_t> curves(round % 3 == 0 ? 0 : random() % 10);
    for (uint8_t& byte : curves) byte = static_cast<uint8_t>(random());
    std::vector<DetailStream> levels(random() % 4);
    for (DetailStream& level : levels) {
      level.step = std::ldexp(1.0F, static_cast<int>(random() % 60) - 30);
      level.bytes.resize(random() % 300);
      for (uint8_t& byte : level.bytes) byte = static_cast<uint8_t>(random());
    }
    try {
      const TriangleMesh decoded = test::decoded_triangles({base, curves}, levels);
      EXPECT_EQ(decoded.triangles.size(), base.triangles.size() << (2 * levels.size()));
      for (const Vec3f p : decoded.positions) ASSERT_LE(std::abs(p.x), coordinate_limit);
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), Fault::not_finite);
    }
  }
}

TEST(Detail, LevelsWithoutResidualsEqualTheButterfly) {
  const TriangleMesh base = test::torus(8, 6);
  const std::vector<DetailStream> levels(2, {.step = 1, .bytes = {255, 255, 255, 255, 255, 255, 255, 255}});
  Options options;
  options.tension = Tension::off;
  const TriangleMesh smooth = refine(build_mesh(base), options).mesh.triangles();
  std::vector<DetailStream> still = levels;
  for (DetailStream& level : still) level.step = std::numeric_limits<float>::min();
  const TriangleMesh decoded = test::decoded_triangles({base}, still);
  ASSERT_EQ(decoded.positions.size(), smooth.positions.size());
  for (size_t v = 0; v < smooth.positions.size(); ++v)
    EXPECT_LT(length(to_double(decoded.positions[v]) - to_double(smooth.positions[v])), 1e-6);
  EXPECT_EQ(decoded.triangles, smooth.triangles);
}

/// Expects the bits that decoders on all processors must produce.
TEST(Detail, DecodedPositionsEqualTheRecordedHash) {
  std::vector<DetailStream> levels(3);
  std::mt19937 random(11);
  for (DetailStream& level : levels) {
    level.step = 0.001F;
    level.bytes.resize(2000);
    for (uint8_t& byte : level.bytes) byte = static_cast<uint8_t>(random());
  }
  const TriangleMesh decoded = test::decoded_triangles({test::icosahedron()}, levels);
  EXPECT_EQ(server::sha256({reinterpret_cast<const char*>(decoded.positions.data()), 12 * decoded.positions.size()}),
            "788cfb5d557e3dcfe0bb6355fbefe9be8b18d8944350d1df80305252e1c8d7ef");
}

TEST(Detail, UnsupportedOriginalsAreRefused) {
  const DetailOptions options;
  const TriangleMesh sphere = test::bumpy_sphere(2);
  EXPECT_EQ(fault_of([&] { (void)encode_detail({}, options, keep_base); }), Fault::no_faces);
  for (const double rms : {0.0, -1.0, 0.2, std::nan("")}) {
    DetailOptions wrong;
    wrong.rms = rms;
    EXPECT_EQ(fault_of([&] { (void)encode_detail(sphere, wrong, keep_base); }), Fault::bad_option);
  }
  const DetailStream level{.step = 1, .bytes = {}};
  EXPECT_EQ(
      fault_of([&] { (void)test::decoded_triangles({test::join(test::fan(3, true), test::fan(4, true), 0)}, {}); }),
      Fault::bad_surface);
  EXPECT_EQ(fault_of([&] { (void)test::decoded_triangles({sphere}, std::vector(11, level)); }), Fault::bad_option);
  EXPECT_EQ(
      fault_of([&] { (void)test::decoded_triangles({sphere}, std::vector(2, level), 15 * sphere.triangles.size()); }),
      Fault::result_too_large);
  for (const float step : {0.0F, -1.0F, std::nanf(""), INFINITY})
    EXPECT_EQ(fault_of([&] {
                (void)test::decoded_triangles({sphere}, std::vector<DetailStream>{{.step = step, .bytes = {}}});
              }),
              Fault::bad_option);
}

TEST(Detail, CancellationStopsEncodingAndDecoding) {
  const TriangleMesh sphere = test::bumpy_sphere(3);
  for (int calls = 0; calls < 60; calls += 11) {
    int left = calls;
    DetailOptions options;
    options.rms = 1e-3;
    options.cancelled = [&] { return left-- == 0; };
    EXPECT_EQ(fault_of([&] { (void)encode_detail(sphere, options, keep_base); }), Fault::cancelled) << calls;
  }
  const std::vector<DetailStream> levels(1, {.step = 1, .bytes = {}});
  EXPECT_EQ(fault_of([&] { (void)test::decoded_triangles({sphere}, levels, face_count_limit, [] { return true; }); }),
            Fault::cancelled);
}

TEST(Detail, SmallestSurfacesAreEncoded) {
  for (const TriangleMesh& original : {test::tetrahedron(), test::octahedron(), test::cube(), test::bipyramid(40)}) {
    DetailOptions options;
    options.rms = 0.01;
    const EncodedDetail encoded = encode_detail(original, options, keep_base);
    EXPECT_FALSE(test::decoded_triangles(encoded.base, encoded.levels).triangles.empty());
  }
}

TEST(Detail, ProgressAscendsToOne) {
  double last = 0;
  DetailOptions options;
  options.rms = 2e-3;
  options.on_progress = [&](double share) {
    EXPECT_GE(share, last);
    last = share;
  };
  (void)encode_detail(test::bumpy_sphere(3), options, keep_base);
  EXPECT_DOUBLE_EQ(last, 1);
}

}  // namespace
}  // namespace papilio
