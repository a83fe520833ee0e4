#include "proto/refinement.h"

#include <gtest/gtest.h>

#include "proto/draco_reader.h"
#include "proto/findings.h"
#include "proto/problem.h"
#include "tests/support/draco_tools.h"
#include "tests/support/shapes.h"

namespace papilio::proto {
namespace {

using namespace test;

const std::string& coarse() {
  static const std::string bytes = encode_with_draco(icosahedron(), Method::edgebreaker);
  return bytes;
}

TEST(Refinement, LevelsComeCoarseFirstAndTheLastIsTheAnswer) {
  const Parameters parameters = parse_query({{"levels", "3"}});
  std::vector<EncodedLevel> levels;
  Refinement refinement(coarse(), parameters, {});
  EXPECT_EQ(refinement.coarse_faces(), 20U);
  const EncodedLevel last = refinement.run({.on_level = [&](const EncodedLevel& level) { levels.push_back(level); }});
  ASSERT_EQ(levels.size(), 4U);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(levels[i].statistics.level, i);
    EXPECT_EQ(levels[i].statistics.faces, 20U << (2 * i));
    EXPECT_EQ(read_draco(levels[i].draco, {}).triangles.size(), levels[i].statistics.faces);
    EXPECT_EQ(levels[i].statistics.stop_reason.has_value(), i == 3);
  }
  EXPECT_EQ(last.draco, levels.back().draco);
  EXPECT_EQ(Refinement(coarse(), parameters, {}).run().draco, last.draco);
}

TEST(Refinement, CertainOverflowIsRefusedBeforeTheWork) {
  const Parameters parameters = parse_query({{"levels", "10"}});
  try {
    const Refinement refinement(coarse(), parameters, {.max_output_faces = 1000});
    FAIL() << "was not refused";
  } catch (const Problem& problem) {
    EXPECT_EQ(problem.code(), Code::result_too_large);
    EXPECT_NE(std::string(problem.what()).find("1280"), std::string::npos);  // the number
  }
}

TEST(Refinement, NaNIsNotEvenEncoded) {
  TriangleMesh mesh = icosahedron();
  mesh.positions[3].z = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW((void)write_draco_exact(mesh), Error);
}

TEST(Refinement, CancelledStops) {
  Refinement refinement(coarse(), parse_query({{"levels", "5"}}), {});
  try {
    (void)refinement.run({.cancelled = [] { return true; }});
    FAIL() << "was not stopped";
  } catch (const Problem& problem) {
    EXPECT_EQ(problem.code(), Code::cancelled);
  }
}

TEST(Refinement, StatisticsAreHeaders) {
  Statistics statistics{.level = 2,
                        .vertices = 10,
                        .faces = 16,
                        .stop_reason = StopReason::converged,
                        .error = 0.00123456,
                        .error_pixels = 2,
                        .found = {.boundary_edges = 7, .non_manifold_edges = 3, .pinched_vertices = 1},
                        .times = {1, 2.5, 3}};
  const auto headers = statistics_headers(statistics);
  const std::vector<std::pair<std::string, std::string>> expected{
      {"Papilio-Vertices", "10"},
      {"Papilio-Faces", "16"},
      {"Papilio-Levels", "2"},
      {"Papilio-Stop-Reason", "converged"},
      {"Papilio-Error", "0.001235"},
      {"Papilio-Error-Pixels", "2"},
      {"Papilio-Found", "non_manifold_edges=3, pinched_vertices=1"},
      {"Server-Timing", "decode;dur=1.000, refine;dur=2.500, encode;dur=3.000"}};
  EXPECT_EQ(headers, expected);
  EXPECT_EQ(parse_defects("non_manifold_edges=3, pinched_vertices=1, new=4, odd").non_manifold_edges, 3U);
  EXPECT_EQ(defects_text(parse_defects(defects_text(statistics.found))), defects_text(statistics.found));
  for (StopReason reason : {StopReason::converged, StopReason::levels, StopReason::budget})
    EXPECT_EQ(stop_reason_named(stop_reason_name(reason)), reason);
  EXPECT_FALSE(stop_reason_named("no"));
}

}  // namespace
}  // namespace papilio::proto
