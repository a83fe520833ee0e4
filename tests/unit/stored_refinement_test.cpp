#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <thread>
#include <variant>

#include "proto/problem.h"
#include "proto/refinement.h"
#include "proto/shared_mesh.h"
#include "tests/support/random_request.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"

namespace papilio::proto {
namespace {

using namespace test;

constexpr uint64_t ample_bytes = 1'000'000'000;

std::string real_draco(const char* name) { return write_draco_exact(real_mesh(name)); }

std::vector<QueryFields> all_requests() {
  std::vector<QueryFields> all{{{"levels", "2"}},
                               {{"levels", "3"}, {"flatness", "0.8,0.9"}},
                               {{"levels", "3"}, {"flatness", "0.8,0.9"}, {"tension", "off"}},
                               {{"levels", "3"}, {"max_faces", "6000"}},
                               {{"levels", "2"}, {"scheme", "in-place"}, {"flatness", "0.9"}}};
  for (int degrees = 0; degrees < 360; degrees += 40) {
    const double angle = degrees * std::acos(-1.0) / 180;
    const QueryFields view{
        {"levels", "3"},
        {"view.eye", std::to_string(2 * std::sin(angle)) + ",0.5," + std::to_string(2 * std::cos(angle))},
        {"view.edge_pixels", "0"}};
    all.push_back(view);
    all.back().emplace_back("view.error_pixels", "0.5");
    all.push_back(view);
    all.back().emplace_back("flatness", "0.8,0.95");
    all.back().emplace_back("simplify_hidden", degrees % 80 == 0 ? "true" : "false");
  }
  return all;
}

void expect_equal(const EncodedLevel& a, const EncodedLevel& b) {
  EXPECT_EQ(a.bytes, b.bytes);
  EXPECT_EQ(a.statistics.faces, b.statistics.faces);
  EXPECT_EQ(a.statistics.stop_reason, b.statistics.stop_reason);
  EXPECT_EQ(a.statistics.error, b.statistics.error);
  EXPECT_EQ(a.statistics.error_pixels, b.statistics.error_pixels);
}

TEST(StoredRefinement, BytesEqualAStreamsResult) {
  for (const char* name : {"bunny600.obj", "elephant2000.obj"}) {
    const std::string draco = real_draco(name);
    for (uint64_t budget : {ample_bytes, uint64_t{2'000'000}}) {
      const auto stored = std::make_shared<const SharedMesh>(draco, Limits{}, budget);
      for (const QueryFields& fields : all_requests()) {
        const Parameters parameters = parse_query(fields);
        Refinement warm(stored, parameters, {});
        Refinement cold(draco, parameters, {});
        EXPECT_EQ(warm.coarse_faces(), cold.coarse_faces());
        expect_equal(warm.run(), cold.run());
      }
    }
  }
}

/// Returns the result, or the error text.
template <class Coarse>
std::variant<EncodedLevel, std::string> answer_of(const Coarse& coarse, const Parameters& parameters) {
  try {
    return Refinement(coarse, parameters, {}).run();
  } catch (const Problem& problem) {
    return problem.what();
  }
}

TEST(StoredRefinement, BytesDoNotDependOnEarlierRequests) {
  int answered = 0;
  constexpr int requests_of_one_mesh = 8;
  for (uint32_t seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    const TriangleMesh triangles = random_small_mesh(random);
    const std::string draco = write_draco_exact(triangles);
    const Mesh coarse = build_mesh(triangles);
    const auto stored = std::make_shared<const SharedMesh>(draco, Limits{}, random() % 2 == 0 ? ample_bytes : 100'000);
    Parameters parameters;
    choose_rules(random, parameters.options);
    for (int request = 0; request < requests_of_one_mesh; ++request) {
      choose_request(random, coarse, parameters.options);
      parameters.output = {.position_bits = static_cast<int>(8 + random() % 9),
                           .speed = static_cast<int>(random() % 11)};
      parameters.normals = random() % 4 == 0;
      SCOPED_TRACE("seed " + std::to_string(seed) + " request " + std::to_string(request));
      const auto warm = answer_of(stored, parameters);
      const auto cold = answer_of(draco, parameters);
      ASSERT_EQ(warm.index(), cold.index());
      if (const auto* refusal = std::get_if<std::string>(&warm)) {
        EXPECT_EQ(*refusal, std::get<std::string>(cold));
        continue;
      }
      ++answered;
      expect_equal(std::get<EncodedLevel>(warm), std::get<EncodedLevel>(cold));
    }
  }
  EXPECT_GT(answered, 600);
}

TEST(StoredRefinement, ConcurrentRequestsEqualSeparateRequests) {
  const std::string draco = real_draco("bunny600.obj");
  const auto stored = std::make_shared<const SharedMesh>(draco, Limits{}, ample_bytes);
  const std::vector<QueryFields> fields = all_requests();
  std::array<std::vector<EncodedLevel>, 3> answers;
  {
    std::vector<std::jthread> threads;
    for (size_t t = 0; t < answers.size(); ++t)
      threads.emplace_back([&, t] {
        for (size_t i = t; i < fields.size(); i += 2)
          answers[t].push_back(Refinement(stored, parse_query(fields[i]), {}).run());
      });
  }
  for (size_t t = 0; t < answers.size(); ++t)
    for (size_t i = t, n = 0; i < fields.size(); i += 2, ++n)
      expect_equal(answers[t][n], Refinement(draco, parse_query(fields[i]), {}).run());
}

TEST(StoredRefinement, RulesShareTheBudget) {
  const std::string draco = real_draco("bunny600.obj");
  const auto after = [&](uint64_t budget, std::initializer_list<const char*> tensions) {
    const auto stored = std::make_shared<const SharedMesh>(draco, Limits{}, budget);
    for (const char* tension : tensions)
      (void)Refinement(stored, parse_query({{"levels", "3"}, {"flatness", "0.9"}, {"tension", tension}}), {}).run();
    return stored->bytes();
  };
  const uint64_t one = after(ample_bytes, {"off"});
  EXPECT_GT(after(ample_bytes, {"off", "soft"}), one);
  EXPECT_GT(after(ample_bytes, {"off", "soft", "sharp"}), after(ample_bytes, {"off", "soft"}));
  EXPECT_LT(after(one, {"off", "soft", "sharp", "off", "off"}), 2 * one);
}

TEST(StoredRefinement, RefusalsEqualAStreams) {
  const std::string draco = write_draco_exact(icosahedron());
  const auto stored = std::make_shared<const SharedMesh>(draco, Limits{}, ample_bytes);
  EXPECT_THROW(Refinement(stored, parse_query({{"levels", "10"}}), {.max_output_faces = 1000}), Problem);
  EXPECT_THROW(SharedMesh("no mesh", Limits{}, ample_bytes), Problem);
  Refinement cancelled(stored, parse_query({{"levels", "3"}, {"flatness", "1"}}), {});
  EXPECT_THROW((void)cancelled.run({.cancelled = [] { return true; }}), Problem);
}

}  // namespace
}  // namespace papilio::proto
