#include "papilio/prepared_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <thread>

#include "papilio/refine.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

constexpr uint64_t plenty = 1'000'000'000;

View view_from(const Mesh& mesh, double degrees, double distance = 1.2) {
  const Box box = bounding_box(mesh.positions);
  const double angle = degrees * std::acos(-1.0) / 180;
  View view;
  view.target = 0.5 * (to_double(box.min) + to_double(box.max));
  view.eye = view.target + (distance * box.diagonal()) * Vec3d{std::sin(angle), 0.3, std::cos(angle)};
  view.edge_pixels = 0;
  return view;
}

View random_view(std::mt19937& random, const Mesh& mesh) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  View view = view_from(mesh, between(0, 360), between(0.2, 2));
  view.projection = static_cast<Projection>(random() % 2);
  if (random() % 2 == 0) view.edge_pixels = between(0, 30);
  if (random() % 2 == 0) view.error_pixels = between(0.2, 5);
  if (random() % 3 == 0) view.lights = {{1, 1, 1}, {-1, 0, 2}};
  return view;
}

/// Sets random options other than the rules.
void ask_at_random(std::mt19937& random, const Mesh& mesh, Options& options) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  options.levels = static_cast<int>(random() % 4);
  options.scheme = random() % 8 == 0 ? Scheme::in_place : Scheme::red_green;
  options.flatness.clear();
  if (random() % 2 == 0)
    for (uint32_t n = random() % 4; n > 0; --n) options.flatness.push_back(between(0.3, 1));
  options.growth = static_cast<Growth>(random() % 3);
  options.tolerance = random() % 3 == 0 ? std::pow(10, between(-4, -2)) : 0;
  options.max_faces = random() % 4 == 0 ? static_cast<uint64_t>(between(1, 6) * mesh.topology.face_count()) : 0;
  options.view.reset();
  if (random() % 3 != 0) options.view = random_view(random, mesh);
  options.simplify_hidden = options.view && random() % 4 == 0;
}

bool is_equal(const Mesh& a, const Mesh& b) {
  const Topology& s = a.topology;
  const Topology& t = b.topology;
  return s.origin == t.origin && s.twin == t.twin && s.edge == t.edge && s.half_edge == t.half_edge &&
         s.kind == t.kind && s.pinched == t.pinched && s.darts == t.darts && a.positions == b.positions &&
         a.attributes.point == b.attributes.point && a.attributes.attributes == b.attributes.attributes;
}

::testing::AssertionResult is_equal(const Result& a, const Result& b) {
  if (!is_equal(a.mesh, b.mesh)) return ::testing::AssertionFailure() << "another mesh";
  if (a.levels != b.levels || a.stop_reason != b.stop_reason) return ::testing::AssertionFailure() << "another end";
  if (a.error != b.error || a.error_pixels != b.error_pixels) return ::testing::AssertionFailure() << "another error";
  return ::testing::AssertionSuccess();
}

/// Compares a sequence of requests of one prepared mesh with cold requests.
void expect_cold_results(const Mesh& coarse, uint32_t seed, uint64_t budget) {
  std::mt19937 random(seed);
  Options options{.tension = static_cast<Tension>(random() % 3)};
  if (random() % 3 == 0) options.crease_angle = 40;
  if (random() % 3 == 0) options.w = 0.03;
  const PreparedMesh prepared(coarse, options, budget);
  for (int request = 0; request < 6; ++request) {
    ask_at_random(random, coarse, options);
    std::vector<Mesh> levels;
    const Result cold = refine(coarse, options, {.on_level = [&](const Level& l) { levels.push_back(l.mesh); }});
    ASSERT_TRUE(is_equal(refine(prepared, options), cold)) << "seed " << seed << " request " << request;
    size_t seen = 0;
    (void)refine(prepared, options, {.on_level = [&](const Level& l) {
                   ASSERT_LT(seen, levels.size());
                   ASSERT_TRUE(is_equal(l.mesh, levels[seen++])) << "seed " << seed << " request " << request;
                 }});
    ASSERT_EQ(seen, levels.size());
  }
}

TEST(PreparedMesh, ResultsEqualColdRequests) {
  for (const char* name : {"bunny600.obj", "cgal/rotor_small.off", "cgal/helmet.off"}) {
    const Mesh coarse = build_mesh(real_mesh(name));
    uint32_t seed = 0;
    for (uint64_t budget : {plenty, uint64_t{3'000'000}, uint64_t{1'000'000}, uint64_t{0}})
      for (int i = 0; i < 4; ++i) expect_cold_results(coarse, seed++, budget);
  }
}

TEST(PreparedMesh, AttributesAndNonManifoldMeshesEqualColdRequests) {
  const TriangleMesh book{{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {1, 0, 0}, {1, 0, 2}, {0, 1, 1}, {-1, -1, 1}},
                          {{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {0, 1, 5}, {1, 2, 5}, {1, 0, 6}, {2, 1, 6}}};
  TriangleMesh charted = real_mesh("bunny600.obj");
  charted.attributes.push_back({2, false, {}});
  for (Vec3f p : charted.positions) charted.attributes[0].values.insert(charted.attributes[0].values.end(), {p.x, p.y});
  for (uint32_t seed = 100; seed < 112; ++seed) {
    expect_cold_results(build_mesh(book), seed, plenty);
    expect_cold_results(build_mesh(charted), seed, seed % 2 == 0 ? plenty : 2'000'000);
  }
}

TEST(PreparedMesh, ErrorEqualsColdRequestsIfNothingIsSplit) {
  // Neighbouring edges have nearly equal errors: the last digits decide which is largest.
  const Mesh coarse = build_mesh(torus(100, 60));
  const PreparedMesh prepared(coarse, {}, plenty);
  for (int i = 0; i < 100; ++i) {
    Options options{.levels = 0, .view = view_from(coarse, 3.6 * i, 0.7)};
    options.view->error_pixels = 1e-6;
    const Result cold = refine(coarse, options);
    EXPECT_GT(cold.error_pixels, 1e-3);
    ASSERT_TRUE(is_equal(refine(prepared, options), cold)) << i;
  }
}

TEST(PreparedMesh, ErrorEqualsColdRequestsIfALevelIsPartlySplit) {
  // The largest deviation is then at an edge where only some neighbouring faces are divided.
  const Mesh coarse = build_mesh(real_mesh("bunny600.obj"));
  const PreparedMesh prepared(coarse, {.tension = Tension::off}, plenty);
  for (int i = 0; i < 50; ++i) {
    const Options options{.levels = 3, .flatness = {1, 0.5 + 0.01 * i, 1}, .tension = Tension::off};
    const Result cold = refine(coarse, options);
    ASSERT_EQ(cold.levels, 3);
    ASSERT_TRUE(is_equal(refine(prepared, options), cold)) << i;
  }
}

TEST(PreparedMesh, ConcurrentRequestsEqualColdRequests) {
  const Mesh coarse = build_mesh(real_mesh("bunny600.obj"));
  for (uint64_t budget : {plenty, uint64_t{1'500'000}}) {
    const PreparedMesh prepared(coarse, {}, budget);
    const auto options_of = [&](int step) {
      Options options{.levels = 3, .view = view_from(coarse, 30.0 * step)};
      options.view->error_pixels = step % 2 == 0 ? 1 : 3;
      if (step % 3 == 0) options.flatness = {0.8, 0.9, 0.95};
      return options;
    };
    std::array<std::vector<Result>, 4> results;
    {
      std::vector<std::jthread> threads;
      for (size_t t = 0; t < results.size(); ++t)
        threads.emplace_back([&, t] {
          for (int step = 0; step < 6; ++step)
            results[t].push_back(refine(prepared, options_of(step + 2 * static_cast<int>(t))));
        });
    }
    for (size_t t = 0; t < results.size(); ++t)
      for (int step = 0; step < 6; ++step)
        EXPECT_TRUE(is_equal(results[t][step], refine(coarse, options_of(step + 2 * static_cast<int>(t)))));
  }
}

TEST(PreparedMesh, KeptLevelsGrowWithinTheBudget) {
  const Mesh coarse = build_mesh(real_mesh("elephant2000.obj"));
  const auto ask = [&](const PreparedMesh& prepared, double degrees) {
    Options options{.levels = 3, .view = view_from(coarse, degrees)};
    options.view->error_pixels = 1;
    options.view->fov_y = 2;  // a small part: for a large part whole levels are built and kept
    (void)refine(prepared, options);
    return prepared.bytes();
  };
  const PreparedMesh prepared(coarse, {}, plenty);
  const uint64_t least = prepared.bytes();
  const uint64_t once = ask(prepared, 0);
  EXPECT_GT(once, least);
  EXPECT_EQ(ask(prepared, 0), once);
  const uint64_t twice = ask(prepared, 90);
  EXPECT_GT(twice, once);
  EXPECT_EQ(ask(prepared, 0), twice);
  EXPECT_EQ(ask(prepared, 90), twice);

  for (uint64_t budget : {uint64_t{0}, once, (once + twice) / 2}) {
    const PreparedMesh small(coarse, {}, budget);
    for (double degrees : {0.0, 90.0, 180.0, 0.0}) EXPECT_LE(ask(small, degrees), std::max(budget, least));
  }
}

TEST(PreparedMesh, CancelledRequestLeavesTheMeshUnchanged) {
  const Mesh coarse = build_mesh(real_mesh("bunny600.obj"));
  Options options{.levels = 3, .view = view_from(coarse, 0)};
  options.view->error_pixels = 0.5;
  const Result cold = refine(coarse, options);
  bool finished = false;
  for (int polls = 0; !finished; ++polls) {
    const PreparedMesh prepared(coarse, options, plenty);
    const uint64_t before = prepared.bytes();
    int left = polls;
    try {
      finished = is_equal(refine(prepared, options, {.cancelled = [&] { return left-- == 0; }}), cold);
      EXPECT_TRUE(finished);
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), Fault::cancelled);
      EXPECT_EQ(prepared.bytes(), before);
      EXPECT_TRUE(is_equal(refine(prepared, options), cold));
    }
    ASSERT_LT(polls, 100);
  }
}

std::string refusal(const PreparedMesh& prepared, const Options& options) {
  try {
    (void)refine(prepared, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(PreparedMesh, MemoryLimitDoesNotCountHeldLevels) {
  const Mesh coarse = build_mesh(real_mesh("elephant2000.obj"));
  Options options{.levels = 3, .view = view_from(coarse, 0)};
  options.view->error_pixels = 1;
  const PreparedMesh prepared(coarse, options, plenty);
  for (double degrees = 0; degrees < 360; degrees += 45) {
    options.view->eye = view_from(coarse, degrees).eye;
    (void)refine(prepared, options);
  }
  int refused = 0;
  for (uint64_t limit = 100'000; limit < 20'000'000; limit += limit / 4) {
    options.memory_limit = limit;
    const PreparedMesh fresh(coarse, options, 0);
    EXPECT_EQ(refusal(prepared, options), refusal(fresh, options));
    refused += refusal(prepared, options).empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 5);
  EXPECT_EQ(refusal(prepared, options), "");
}

TEST(PreparedMesh, OtherRulesAreRefused) {
  const PreparedMesh prepared(build_mesh(icosahedron()), {}, plenty);
  EXPECT_TRUE(prepared.suits({.levels = 5, .flatness = {0.5}}));
  for (const Options& other : {Options{.tension = Tension::off}, Options{.w = 0.01}, Options{.crease_angle = 30}}) {
    EXPECT_FALSE(prepared.suits(other));
    EXPECT_NE(refusal(prepared, other), "");
  }
}

/// A torus with triangles added at some of its edges.
TriangleMesh torus_with_fins(std::mt19937& random) {
  std::uniform_real_distribution<float> anywhere(-1, 1);
  TriangleMesh mesh = torus(10, 8);
  const size_t faces = mesh.triangles.size();
  for (Vec3f& p : mesh.positions) p += 0.05F * Vec3f{anywhere(random), anywhere(random), anywhere(random)};
  for (int i = 0; i < 12; ++i) {
    const Triangle at = mesh.triangles[random() % faces];
    const auto tip = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.push_back({1.5F * anywhere(random), 1.5F * anywhere(random), anywhere(random)});
    mesh.triangles.push_back({at[0], at[1], tip});
  }
  return mesh;
}

TEST(PreparedMesh, SharedEdgesEqualColdRequestsInWholeLevels) {
  std::mt19937 random(7);
  for (int i = 0; i < 60; ++i) {
    const Mesh mesh = build_mesh(torus_with_fins(random));
    Options options{.levels = 4};
    options.view = view_from(mesh, 50.0 * i, 0.8);
    options.view->fov_y = 25;
    options.view->error_pixels = 0.5 + 0.1 * i;
    if (i % 2 == 0) options.view->lights = {{1, 2, 3}};
    const PreparedMesh prepared(mesh, options, plenty);
    (void)refine(prepared, Options{.levels = 3, .tolerance = 1e-4});  // whole levels are kept
    const Result warm = refine(prepared, options);
    const Result cold = refine(mesh, options);
    EXPECT_EQ(warm.mesh.topology.origin, cold.mesh.topology.origin);
    EXPECT_EQ(warm.error, cold.error);
    EXPECT_EQ(warm.error_pixels, cold.error_pixels);
  }
}

}  // namespace
}  // namespace papilio
