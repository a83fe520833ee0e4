#include "proto/refinement.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <thread>

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

TEST(Refinement, LevelsAreReportedCoarseFirstUpToTheResult) {
  const Parameters parameters = parse_query({{"levels", "3"}});
  std::vector<EncodedLevel> levels;
  Refinement refinement(coarse(), parameters, {});
  EXPECT_EQ(refinement.coarse_faces(), 20U);
  const EncodedLevel last = refinement.run({.on_level = [&](const EncodedLevel& level) { levels.push_back(level); }});
  ASSERT_EQ(levels.size(), 4U);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(levels[i].statistics.level, i);
    EXPECT_EQ(levels[i].statistics.faces, 20U << (2 * i));
    EXPECT_EQ(read_draco(levels[i].bytes, {}).triangles.size(), levels[i].statistics.faces);
    EXPECT_EQ(levels[i].statistics.stop_reason.has_value(), i == 3);
  }
  EXPECT_EQ(last.bytes, levels.back().bytes);
  EXPECT_EQ(Refinement(coarse(), parameters, {}).run().bytes, last.bytes);
}

TEST(Refinement, LevelIsReportedWhileTheNextIsRefined) {
  std::atomic<int> steps = 0;
  std::vector<int> levels;
  const auto run = [&](int threads, const std::function<void()>& at_first) {
    steps = 0;
    levels.clear();
    Refinement refinement(coarse(), parse_query({{"levels", "3"}}), {});
    const auto look = [&](const EncodedLevel& level) {
      levels.push_back(level.statistics.level);
      if (level.statistics.level == 0) at_first();
    };
    (void)refinement.run({.on_level = look, .cancelled = [&] { return ++steps < 0; }, .threads = threads});
    EXPECT_EQ(levels, (std::vector<int>{0, 1, 2, 3}));
  };
  int before = 0;  // steps before the first level
  run(1, [&] { before = steps; });
  bool went_on = false;
  run(2, [&] {
    for (int i = 0; i < 2000 && steps == before; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    went_on = steps > before;
  });
  EXPECT_TRUE(went_on);
}

TEST(Refinement, LevelsAreBitIdenticalOnSeveralThreads) {
  for (const QueryFields& fields : {QueryFields{{"levels", "4"}}, {{"levels", "4"}, {"tolerance", "0.0001"}}}) {
    const auto levels = [&](int threads) {
      std::vector<EncodedLevel> all;
      Refinement refinement(coarse(), parse_query(fields), {});
      (void)refinement.run({.on_level = [&](const EncodedLevel& level) { all.push_back(level); }, .threads = threads});
      return all;
    };
    const std::vector<EncodedLevel> one = levels(1);
    const std::vector<EncodedLevel> two = levels(2);
    ASSERT_EQ(one.size(), two.size());
    for (size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(one[i].bytes, two[i].bytes);
      EXPECT_EQ(one[i].statistics.faces, two[i].statistics.faces);
      EXPECT_EQ(one[i].statistics.level, two[i].statistics.level);
    }
  }
}

TEST(Refinement, ThrowingLevelHookStopsRefinement) {
  for (int threads : {1, 2, 3})
    for (int at : {0, 2, 3})
      for (uint64_t limit : {5000U, 400U}) {  // faces: level 3 would exceed the second limit
        Refinement refinement(coarse(), parse_query({{"levels", "3"}, {"tolerance", "1e-9"}}),
                              {.max_output_faces = limit});
        const auto stop = [&](const EncodedLevel& level) {
          if (level.statistics.level == at) throw std::out_of_range("enough");
        };
        if (at == 3 && limit < 1000)
          EXPECT_THROW((void)refinement.run({.on_level = stop, .threads = threads}), Problem);
        else
          EXPECT_THROW((void)refinement.run({.on_level = stop, .threads = threads}), std::out_of_range);
      }
}

/// Returns the statistics of the refined icosahedron.
Statistics refined(const QueryFields& fields, const Limits& limits = {}) {
  return Refinement(coarse(), parse_query(fields), limits).run().statistics;
}

TEST(Refinement, OmittedLevelsReachTheErrorTarget) {
  for (const char* scheme : {"red-green", "in-place"})
    for (const char* tolerance : {"0.003", "0.0003"}) {
      const Statistics made = refined({{"tolerance", tolerance}, {"scheme", scheme}});
      EXPECT_EQ(made.stop_reason, StopReason::converged) << scheme << tolerance;
      EXPECT_LE(made.error, std::atof(tolerance));
      EXPECT_GT(made.level, 2);
      EXPECT_EQ(made.unreached, "");
      const Statistics bounded = refined({{"tolerance", tolerance}, {"scheme", scheme}, {"levels", "10"}});
      EXPECT_EQ(bounded.faces, made.faces);
    }
  const Statistics seen = refined({{"view.error_pixels", "0.5"}});
  EXPECT_EQ(seen.stop_reason, StopReason::converged);
  EXPECT_LE(seen.error_pixels.value(), 0.5);
}

TEST(Refinement, UnreachedTargetsAreReported) {
  const Statistics made = refined({{"tolerance", "0.0003"}, {"levels", "1"}});
  EXPECT_EQ(made.stop_reason, StopReason::levels);
  EXPECT_GT(made.error, 0.0003);
  EXPECT_NE(made.unreached.find("tolerance=0.0003 is not reached"), std::string::npos) << made.unreached;
  EXPECT_NE(made.unreached.find("Raise levels above 1"), std::string::npos) << made.unreached;
  const Statistics budget = refined({{"view.error_pixels", "0.1"}, {"max_faces", "100"}});
  EXPECT_NE(budget.unreached.find("view.error_pixels=0.1 is not reached"), std::string::npos) << budget.unreached;
  EXPECT_NE(budget.unreached.find("max_faces"), std::string::npos) << budget.unreached;
}

TEST(Refinement, UnreachedTargetsNameOnlyCriteriaThatWereGiven) {
  const Statistics grid = refined({{"tolerance", "0.001"}, {"output.position_bits", "8"}});
  EXPECT_NE(grid.unreached.find("The grid of output.position_bits=8 accounts for 0.00"), std::string::npos)
      << grid.unreached;
  EXPECT_NE(grid.unreached.find("Raise output.position_bits"), std::string::npos) << grid.unreached;
  EXPECT_EQ(grid.unreached.find("criteria"), std::string::npos) << grid.unreached;
  const Statistics finest = refined({{"tolerance", "8e-6"}, {"output.position_bits", "16"}, {"levels", "10"}});
  EXPECT_NE(finest.unreached.find("16 bits are the maximum"), std::string::npos) << finest.unreached;
  const Statistics flat = refined({{"tolerance", "0.0003"}, {"flatness", "0.5"}});
  EXPECT_NE(flat.unreached.find("Other criteria exclude edges: flatness. "), std::string::npos) << flat.unreached;
  const Statistics seen = refined({{"tolerance", "0.0003"}, {"view.edge_pixels", "200"}});
  EXPECT_NE(seen.unreached.find("exclude edges: view.edge_pixels, the view. "), std::string::npos) << seen.unreached;
}

TEST(Refinement, OmittedLevelsStopAtTheLimits) {
  for (const char* scheme : {"red-green", "in-place"})
    for (const Limits& limits : {Limits{.max_output_faces = 2000}, Limits{.max_compute_bytes = 300 << 10}}) {
      const QueryFields fields{{"tolerance", "1e-7"}, {"scheme", scheme}};
      const Statistics made = refined(fields, limits);
      EXPECT_EQ(made.stop_reason, StopReason::limits) << scheme;
      EXPECT_LE(made.faces, limits.max_output_faces);
      EXPECT_GT(made.error, 1e-7);
      EXPECT_NE(made.unreached.find("limit"), std::string::npos) << made.unreached;
      // Expects the result of the last level within the limit.
      QueryFields bounded = fields;
      bounded.emplace_back("levels", std::to_string(made.level));
      EXPECT_EQ(refined(bounded).faces, made.faces);
      bounded.back().second = std::to_string(made.level + 1);
      EXPECT_THROW((void)refined(bounded, limits), Problem);
    }
}

TEST(Refinement, CertainOverflowIsRefusedBeforeRefinement) {
  const Parameters parameters = parse_query({{"levels", "10"}});
  try {
    const Refinement refinement(coarse(), parameters, {.max_output_faces = 1000});
    FAIL() << "was not refused";
  } catch (const Problem& problem) {
    EXPECT_EQ(problem.code(), Code::result_too_large);
    EXPECT_NE(std::string(problem.what()).find("1280"), std::string::npos);  // the predicted faces
  }
}

TEST(Refinement, NaNIsRefusedBeforeEncoding) {
  TriangleMesh mesh = icosahedron();
  mesh.positions[3].z = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW((void)write_draco_exact(mesh), Error);
}

TEST(Refinement, CancelledHookStopsRefinement) {
  Refinement refinement(coarse(), parse_query({{"levels", "5"}}), {});
  try {
    (void)refinement.run({.cancelled = [] { return true; }});
    FAIL() << "was not stopped";
  } catch (const Problem& problem) {
    EXPECT_EQ(problem.code(), Code::cancelled);
  }
}

TEST(Refinement, CancelledHookStopsTheEncoder) {
  const std::string draco = write_draco_exact(test::torus(330, 200));
  const auto run = [&](const std::function<bool()>& cancelled) {
    Refinement refinement(draco, parse_query({{"levels", "0"}}), {});
    (void)refinement.run({.cancelled = cancelled});
  };
  int calls = 0;
  run([&] { return ++calls < 0; });
  EXPECT_GT(calls, 8);  // once per 65,536 faces or vertices of each pass
  for (int last = calls; last > calls - 6; --last) {
    int left = last;
    EXPECT_THROW(run([&] { return --left == 0; }), Problem);
  }
}

TEST(Refinement, TimeLimitExcludesWaitsOfTheCaller) {
  int questions = 0;
  const auto wait_once = [&] {
    if (++questions == 1) std::this_thread::sleep_for(std::chrono::milliseconds(2200));
    return false;
  };
  Refinement refinement(coarse(), parse_query({{"levels", "3"}}), {.max_compute_seconds = 2});
  EXPECT_EQ(refinement.run({.cancelled = wait_once}).statistics.faces, 20U << 6);
  EXPECT_GT(questions, 1);
}

TEST(Refinement, StatisticsAreFormattedAsHeaders) {
  Statistics statistics{.level = 2,
                        .vertices = 10,
                        .faces = 16,
                        .stop_reason = StopReason::converged,
                        .error = 0.00123456,
                        .error_pixels = 2,
                        .unreached = "Not fine enough.",
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
      {"Papilio-Unreached", "Not fine enough."},
      {"Papilio-Found", "non_manifold_edges=3, pinched_vertices=1"},
      {"Server-Timing", "decode;dur=1.000, refine;dur=2.500, encode;dur=3.000"}};
  EXPECT_EQ(headers, expected);
  EXPECT_EQ(parse_defects("non_manifold_edges=3, pinched_vertices=1, new=4, odd").non_manifold_edges, 3U);
  EXPECT_EQ(defects_text(parse_defects(defects_text(statistics.found))), defects_text(statistics.found));
  for (StopReason reason : {StopReason::converged, StopReason::levels, StopReason::budget, StopReason::limits})
    EXPECT_EQ(stop_reason_named(stop_reason_name(reason)), reason);
  EXPECT_FALSE(stop_reason_named("no"));
}

}  // namespace
}  // namespace papilio::proto
