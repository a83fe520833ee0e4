#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>

#include "papilio/prepared_mesh.h"
#include "papilio/refine.h"
#include "tests/support/random_request.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

/// Outcome of a request: its result or its error.
struct Answer {
  std::optional<Result> result;
  std::string refusal;
};

template <class Coarse>
Answer ask(const Coarse& coarse, const Options& options) {
  try {
    return {refine(coarse, options), ""};
  } catch (const Error& error) {
    return {std::nullopt, error.what()};
  }
}

std::string first_difference(const Answer& stored, const Answer& cold) {
  if (stored.refusal != cold.refusal) return "refusal: " + stored.refusal + " | " + cold.refusal;
  if (!cold.result) return "";
  const Result& a = *stored.result;
  const Result& b = *cold.result;
  const Topology& s = a.mesh.topology;
  const Topology& t = b.mesh.topology;
  if (s.face_count() != t.face_count())
    return "faces: " + std::to_string(s.face_count()) + ", cold " + std::to_string(t.face_count());
  if (s.origin != t.origin) return "corners";
  if (a.mesh.positions != b.mesh.positions) return "positions";
  if (s.twin != t.twin || s.edge != t.edge || s.half_edge != t.half_edge || s.kind != t.kind) return "edges";
  if (s.pinched != t.pinched || s.darts != t.darts) return "vertices";
  if (a.levels != b.levels || a.stop_reason != b.stop_reason) return "end";
  if (a.error != b.error) return "error: " + std::to_string(a.error) + ", cold " + std::to_string(b.error);
  if (a.error_pixels != b.error_pixels)
    return "error in pixels: " + std::to_string(a.error_pixels) + ", cold " + std::to_string(b.error_pixels);
  return "";
}

/// Number of requests compared. Each takes ten times as long with sanitizers.
uint32_t pairs_asked_for() {
  if (const char* pairs = std::getenv("PAPILIO_PAIRS")) return static_cast<uint32_t>(std::stoul(pairs));
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(NDEBUG)
  return 2'000;
#else
  return 50'000;
#endif
}

TEST(PreparedMesh, ResultsDoNotDependOnEarlierRequests) {
  constexpr uint32_t requests_of_one_mesh = 8;
  const uint32_t pairs = pairs_asked_for();
  uint32_t compared = 0;
  for (uint32_t seed = 0; compared < pairs; ++seed) {
    std::mt19937 random(seed);
    const Mesh coarse = build_mesh(random_small_mesh(random));
    Options options;
    choose_rules(random, options);
    const uint64_t budget = random() % 4 == 0 ? random() % 200'000 : 1'000'000'000;
    const PreparedMesh prepared(coarse, options, budget);
    for (uint32_t request = 0; request < requests_of_one_mesh; ++request, ++compared) {
      choose_request(random, coarse, options);
      EXPECT_EQ(first_difference(ask(prepared, options), ask(coarse, options)), "")
          << "seed " << seed << " request " << request;
    }
  }
}

TEST(PreparedMesh, RoundingOfDeviationsDoesNotDependOnEarlierRequests) {
  // Quadrangles are flat up to rounding, and pixels are small enough for rounding to matter.
  const Mesh coarse = build_mesh(torus(8, 8));
  Options rules;
  rules.crease_angle = 30;
  const PreparedMesh prepared(coarse, rules, 1'000'000'000);
  Options earlier = rules;
  earlier.max_faces = 1500;
  (void)refine(prepared, earlier);
  std::mt19937 random(1);
  const auto share = [&] { return static_cast<double>(random()) / 2147483648.0 - 1; };
  for (int i = 0; i < 600; ++i) {
    View view{.target = {share(), share(), 0.4 * share()}, .fov_y = 1.0 + i % 30, .viewport = {1e6, 1e6}};
    view.eye = view.target + std::ldexp(1.0, -(i % 50)) * Vec3d{share(), share(), share()};
    view.near = i % 2 == 0 ? 1e-9 : 0;
    view.edge_pixels = 0;
    view.error_pixels = std::ldexp(0.01, i % 27);
    view.lights = {{share(), share(), share()}};
    view.projection = Projection::orthographic;
    Options options = rules;
    options.view = view;
    EXPECT_EQ(first_difference(ask(prepared, options), ask(coarse, options)), "") << i;
  }
}

}  // namespace
}  // namespace papilio
