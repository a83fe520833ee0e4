#include "papilio/refine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/parallel.h"
#include "tests/support/invariants.h"
#include "tests/support/openmesh_oracle.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

Fault fault_of(const TriangleMesh& mesh, const Options& options, const Hooks& hooks = {}) {
  try {
    (void)refine(build_mesh(mesh), options, hooks);
  } catch (const Error& error) {
    return error.fault();
  }
  ADD_FAILURE() << "was not refused";
  return Fault::no_faces;
}

/// Returns the largest distance from a point of `a` to the nearest point of `b`, found in a grid of cells of size
/// `cell`; infinity if the neighbouring cells are empty.
double one_sided_distance(const Buffer<Vec3d>& a, const Buffer<Vec3d>& b, double cell) {
  using Cell = std::array<int64_t, 3>;
  const auto cell_of = [&](Vec3d p) {
    return Cell{std::llround(p.x / cell), std::llround(p.y / cell), std::llround(p.z / cell)};
  };
  std::multimap<Cell, Vec3d> grid;
  for (Vec3d p : b) grid.emplace(cell_of(p), p);
  double largest = 0;
  for (Vec3d p : a) {
    double nearest = std::numeric_limits<double>::infinity();
    const Cell centre = cell_of(p);
    for (int64_t i = 0; i < 27; ++i) {
      const Cell near{centre[0] + i % 3 - 1, centre[1] + i / 3 % 3 - 1, centre[2] + i / 9 - 1};
      const auto [begin, end] = grid.equal_range(near);
      for (auto it = begin; it != end; ++it) nearest = std::min(nearest, length(it->second - p));
    }
    largest = std::max(largest, nearest);
  }
  return largest;
}

void expect_equal_to_openmesh(const TriangleMesh& mesh, int most_levels) {
  const Mesh coarse = build_mesh(mesh);
  const double diagonal = bounding_box(coarse.positions).diagonal();
  for (int level = 1; level <= most_levels; ++level) {
    const Result ours = refine(coarse, {.levels = level, .tension = Tension::off});
    const OracleResult theirs = openmesh_butterfly(mesh, static_cast<size_t>(level));
    ASSERT_EQ(ours.mesh.topology.face_count(), theirs.faces);
    ASSERT_EQ(ours.mesh.positions.size(), theirs.positions.size());
    Buffer<Vec3d> positions;
    for (Vec3f p : ours.mesh.positions) positions.push_back(to_double(p));
    EXPECT_LE(one_sided_distance(positions, theirs.positions, 1e-4 * diagonal), 1e-6 * diagonal) << level;
    EXPECT_LE(one_sided_distance(theirs.positions, positions, 1e-4 * diagonal), 1e-6 * diagonal) << level;
  }
}

TEST(Refine, ClosedRealMeshEqualsOpenMesh) { expect_equal_to_openmesh(real_mesh("elephant2000.obj"), 3); }
TEST(Refine, BunnyEqualsOpenMesh) { expect_equal_to_openmesh(real_mesh("bunny600.obj"), 3); }
TEST(Refine, ShapesEqualOpenMesh) {
  expect_equal_to_openmesh(tetrahedron(), 3);
  expect_equal_to_openmesh(icosahedron(), 3);
  expect_equal_to_openmesh(cube(), 3);
  expect_equal_to_openmesh(torus(5, 7), 3);
  expect_equal_to_openmesh(bipyramid(12), 3);
}

TEST(Refine, ResultWithoutEdgesHasEqualFaces) {
  const View view{.eye = {0, 0, 30}, .edge_pixels = 0, .error_pixels = 0.01};
  for (const Options& way :
       {Options{.levels = 2}, Options{.levels = 2, .w = 0.05}, Options{.levels = 0},
        Options{.levels = 2, .tolerance = 1e-3}, Options{.levels = 2, .scheme = Scheme::in_place, .flatness = {0.95}},
        Options{.levels = 2, .view = view, .simplify_hidden = true}}) {
    for (const TriangleMesh& mesh : {join(icosahedron(), cube(), 5), grid(4, 3)}) {
      Options options = way;
      const Result whole = refine(build_mesh(mesh), options);
      options.edges = false;
      Result bare = refine(build_mesh(mesh), options);
      EXPECT_TRUE(whole.mesh.topology.has_edges());
      EXPECT_FALSE(bare.mesh.topology.has_edges());
      EXPECT_EQ(bare.mesh.triangles(), whole.mesh.triangles());
      EXPECT_EQ(bare.mesh.topology.twin, whole.mesh.topology.twin);
      EXPECT_EQ(bare.error, whole.error);
      const uint32_t faces = bare.mesh.topology.face_count();
      EXPECT_EQ(refine(std::move(bare.mesh), {.levels = 1}).mesh.topology.face_count(), 4 * faces);
    }
  }
}

TEST(Refine, ResultIsBitIdenticalForAnyThreads) {
  const View view{.eye = {0, 0, 30}, .edge_pixels = 0, .error_pixels = 1e-4};
  size_t large = 0;
  for (const TriangleMesh& mesh : {grid(30, 40), join(box({9, 9, 9}, {3, 2, 1}), torus(50, 20), 20)})
    for (const Options& options :
         {Options{.levels = 3, .tension = Tension::off}, Options{.levels = 3, .tension = Tension::sharp},
          Options{.levels = 3, .tension = Tension::off, .edges = false}, Options{.levels = 3, .w = 0.03},
          Options{.levels = 3, .crease_angle = 40, .tolerance = 1e-7}, Options{.levels = 3, .flatness = {1}},
          Options{.levels = 3, .view = view}}) {
      const Result one = refine(build_mesh(mesh), options);
      if (one.mesh.topology.face_count() > 8 * least_per_thread) ++large;
      for (int threads : {3}) {
        const Result many = refine(build_mesh(mesh), options, {.threads = threads});
        ASSERT_EQ(many.mesh.triangles(), one.mesh.triangles());
        ASSERT_EQ(many.mesh.topology.half_edge, one.mesh.topology.half_edge);
        ASSERT_EQ(many.error, one.error);
        ASSERT_EQ(many.error_pixels, one.error_pixels);
      }
    }
  EXPECT_GT(large, 8U);
}

TEST(Refine, EachUniformLevelQuadruplesTheFaces) {
  const TriangleMesh bunny = real_mesh("bunny600.obj");
  for (int level = 0; level <= 4; ++level) {
    Options options;
    options.levels = level;
    const Result result = refine(build_mesh(bunny), options);
    EXPECT_EQ(result.mesh.topology.face_count(), 600U << (2 * level));
    EXPECT_EQ(result.levels, level);
    EXPECT_EQ(result.stop_reason, StopReason::levels);
    EXPECT_EQ(result.mesh.topology.euler_characteristic(), 2);
  }
}

TEST(Refine, AdaptiveAndViewResultsHaveFewerFaces) {
  const Mesh bunny = build_mesh(real_mesh("bunny600.obj"));
  Options options;
  options.flatness = {0.8, 0.9};
  const uint32_t adaptive = refine(bunny, options).mesh.topology.face_count();
  EXPECT_LE(adaptive, 600 * 16 * 65 / 100);
  EXPECT_GT(adaptive, 600U);
  const Box box = bounding_box(bunny.positions);
  View view;
  view.target = 0.5 * (to_double(box.min) + to_double(box.max));
  view.eye = view.target + Vec3d{0, 0, 1.5 * box.diagonal()};
  options.view = view;
  const uint32_t dependent = refine(bunny, options).mesh.topology.face_count();
  EXPECT_LT(dependent, adaptive);
  EXPECT_GT(dependent, 600U);
}

View random_view(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  View view;
  view.eye = {between(-5, 25), 1, 7};
  view.edge_pixels = between(0, 100);
  view.projection = static_cast<Projection>(random() % 2);
  if (random() % 3 == 0) view.error_pixels = between(0.1, 20);
  if (random() % 3 == 0) view.lights = {{1, 1, 1}, {-1, 0, 2}};
  return view;
}

Options random_options(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Options options;
  options.levels = static_cast<int>(random() % 4);
  options.scheme = static_cast<Scheme>(random() % 2);
  options.tension = static_cast<Tension>(random() % 3);
  for (uint32_t n = random() % 4; n > 0; --n) options.flatness.push_back(between(-1, 1));
  options.growth = static_cast<Growth>(random() % 3);
  if (random() % 3 == 0) options.crease_angle = between(0, 180);
  if (random() % 3 == 0) options.tolerance = std::pow(10, between(-4, -1));
  if (random() % 4 == 0) options.max_faces = 500 + random() % 2000;
  if (random() % 2 == 0) options.view = random_view(random);
  return options;
}

TEST(Refine, RandomMeshesAndOptionsKeepEveryInvariant) {
  for (uint32_t seed = 0; seed < 400; ++seed) {
    std::mt19937 random(seed);
    const Mesh coarse = build_mesh(random_manifold(random));
    const Options options = random_options(random);
    const EdgeCensus before = count_edges(coarse.triangles());
    int last_level = -1;
    const Hooks hooks{.on_level = [&](const Level& level) {
      ASSERT_GT(level.level, last_level);  // levels without targets are not reported
      last_level = level.level;
      ASSERT_TRUE(is_consistent(level.mesh)) << "seed " << seed << " level " << level.level;
      ASSERT_EQ(level.mesh.topology.euler_characteristic(), coarse.topology.euler_characteristic());
      if (options.max_faces > 0) {
        ASSERT_LE(level.mesh.topology.face_count(), options.max_faces);
      }
      const EdgeCensus census = count_edges(level.mesh.triangles());
      ASSERT_EQ(census.irregular, 0U);
      if (before.boundary == 0) {
        ASSERT_EQ(census.boundary, 0U);
      }
      ASSERT_TRUE(std::equal(coarse.positions.begin(), coarse.positions.end(), level.mesh.positions.begin()));
    }};
    const Result result = refine(coarse, options, hooks);
    ASSERT_EQ(result.levels, last_level);
    for (Vec3f p : result.mesh.positions) ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    const Result again = refine(coarse, options);
    ASSERT_EQ(again.mesh.triangles(), result.mesh.triangles()) << "seed " << seed;
  }
}

TEST(Refine, NonManifoldAndMisorientedMeshesHaveNoCracks) {
  TriangleMesh book{{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {1, 0, 0}, {1, 0, 2}, {0, 1, 1}, {-1, -1, 1}},
                    {{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {0, 1, 5}, {1, 2, 5}, {1, 0, 6}, {2, 1, 6}}};
  const Result result = refine(build_mesh(book), {.levels = 3});
  EXPECT_TRUE(is_consistent(result.mesh));
  EXPECT_EQ(count_edges(result.mesh.triangles()).irregular, 16U);  // two shared edges, each in eight
}

TEST(Refine, LevelsWithoutTargetsAreNotReported) {
  std::vector<int> levels;
  const Result result =
      refine(build_mesh(icosahedron()), {.levels = 3, .scheme = Scheme::in_place, .flatness = {-1, 1, -1}},
             {.on_level = [&](const Level& level) {
               levels.push_back(level.level);
               EXPECT_EQ(level.last, level.level == 2);
             }});
  EXPECT_EQ(levels, (std::vector<int>{0, 2}));
  EXPECT_EQ(result.levels, 2);
  EXPECT_EQ(result.stop_reason, StopReason::converged);
}

TEST(Refine, MoebiusStripIsRefinedWithoutACrack) {
  // Seven quadrangles in a ring with half a turn: non-orientable, so some edges are misoriented.
  TriangleMesh strip;
  constexpr uint32_t n = 7;
  for (uint32_t i = 0; i < n; ++i) {
    const double u = 2 * 3.14159265358979 * i / n;
    for (double v : {-0.3, 0.3}) {
      const double r = 1 + v * std::cos(u / 2);
      strip.positions.push_back(to_float({r * std::cos(u), r * std::sin(u), v * std::sin(u / 2)}));
    }
    const bool turned = i + 1 == n;
    const uint32_t a = 2 * i;
    const uint32_t b = 2 * ((i + 1) % n);
    strip.triangles.push_back({a, b + (turned ? 1 : 0), a + 1});
    strip.triangles.push_back({a + 1, b + (turned ? 1 : 0), b + (turned ? 0 : 1)});
  }
  BuildReport report;
  const Mesh mesh = build_mesh(strip, &report);
  EXPECT_EQ(report.misoriented_edges, 1U);
  EXPECT_EQ(mesh.topology.euler_characteristic(), 0);
  const Result result = refine(mesh, {.levels = 3});
  EXPECT_TRUE(is_consistent(result.mesh));
  EXPECT_EQ(result.mesh.topology.euler_characteristic(), 0);
  EXPECT_EQ(count_edges(result.mesh.triangles()).irregular, 8U);
}

TEST(Refine, TriangleSoupsKeepTheirInvariants) {
  for (uint32_t seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    TriangleMesh soup;
    const uint32_t points = 4 + static_cast<uint32_t>(random()) % 6;
    std::uniform_real_distribution<float> coordinate(-1, 1);
    for (uint32_t p = 0; p < points; ++p)
      soup.positions.push_back({coordinate(random), coordinate(random), coordinate(random)});
    for (uint32_t t = 1 + random() % 12; t > 0; --t) {
      const uint32_t a = static_cast<uint32_t>(random()) % points;
      const uint32_t beyond = 2 + static_cast<uint32_t>(random()) % (points - 2);
      soup.triangles.push_back({a, (a + 1) % points, (a + beyond) % points});
    }
    const Mesh mesh = build_mesh(soup);
    ASSERT_TRUE(is_consistent(mesh)) << seed;
    const int64_t euler = mesh.topology.euler_characteristic();
    const Result result = refine(mesh, {.levels = 2, .flatness = {0.5, 0.9}, .growth = static_cast<Growth>(seed % 3)});
    ASSERT_EQ(result.mesh.topology.euler_characteristic(), euler) << seed;
    for (Vec3f p : result.mesh.positions) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z)) << seed;
  }
}

TEST(Refine, RefinementConvergesOnceNothingIsSplit) {
  Options options;
  options.levels = 10;
  options.flatness = {0.99};
  const Result result = refine(build_mesh(grid(2, 2)), {.levels = 10, .flatness = {-1}});
  EXPECT_EQ(result.stop_reason, StopReason::converged);
  EXPECT_EQ(result.levels, 0);
  const Result sphere = refine(build_mesh(icosahedron()), options);  // each level is flatter
  EXPECT_EQ(sphere.stop_reason, StopReason::converged);
  EXPECT_GT(sphere.levels, 1);
}

TEST(Refine, LastThresholdAppliesToFurtherLevels) {
  const Mesh mesh = build_mesh(icosahedron());
  const auto faces = [&](std::vector<double> flatness, int levels) {
    return refine(mesh, {.levels = levels, .scheme = Scheme::in_place, .flatness = std::move(flatness)})
        .mesh.topology.face_count();
  };
  EXPECT_EQ(faces({-1, 1}, 1), 20U);
  EXPECT_EQ(faces({-1, 1}, 2), 80U);  // a level without targets does not end refinement: level 2 is finer
  EXPECT_EQ(faces({-1, -1, 1, -1}, 4), 80U);
  EXPECT_EQ(faces({1, 1, 1}, 2), 320U);
  EXPECT_EQ(faces({1}, 3), faces({1, 1, 1}, 3));
}

TEST(Refine, FaceLimitRefusesBeforeTheLevelIsBuilt) {
  Options options;
  options.levels = 10;
  options.face_limit = 1000;
  EXPECT_EQ(fault_of(icosahedron(), options), Fault::result_too_large);
  options.flatness = {1};  // not predictable: checked level by level
  int levels = 0;
  EXPECT_EQ(fault_of(icosahedron(), options, {.on_level = [&](const Level&) { ++levels; }}), Fault::result_too_large);
  EXPECT_EQ(levels, 3);  // 20, 80, 320; 1280 is refused
}

TEST(Refine, HiddenFacesAreSimplified) {
  const Mesh bunny = build_mesh(real_mesh("bunny.obj"));
  const Box box = bounding_box(bunny.positions);
  View view;
  view.target = 0.5 * (to_double(box.min) + to_double(box.max));
  view.eye = view.target + Vec3d{0, 0, box.diagonal()};
  view.edge_pixels = 4;
  for (Scheme scheme : {Scheme::red_green, Scheme::in_place}) {
    Options options{.levels = 1, .scheme = scheme, .view = view};
    const Result whole = refine(bunny, options);
    options.simplify_hidden = true;
    int last_faces = 0;
    const Result less = refine(bunny, options, {.on_level = [&](const Level& level) {
                                 if (level.last) last_faces = static_cast<int>(level.mesh.topology.face_count());
                               }});
    EXPECT_LT(less.mesh.topology.face_count(), whole.mesh.topology.face_count() * 9 / 10);
    EXPECT_EQ(last_faces, static_cast<int>(less.mesh.topology.face_count()));
    EXPECT_EQ(less.mesh.topology.euler_characteristic(), whole.mesh.topology.euler_characteristic());
    EXPECT_TRUE(is_consistent(less.mesh));
  }
  EXPECT_EQ(fault_of(icosahedron(), {.simplify_hidden = true}), Fault::bad_option);  // nothing is hidden without a view
}

TEST(Refine, CancellationStopsWithinOneStep) {
  int asked = 0;
  const Hooks hooks{.cancelled = [&] { return ++asked == 3; }};
  EXPECT_EQ(fault_of(icosahedron(), {.levels = 8}, hooks), Fault::cancelled);
  EXPECT_EQ(asked, 3);
}

TEST(Refine, CancellationStopsSimplification) {
  const Mesh fine = refine(build_mesh(torus(24, 12)), {.levels = 2}).mesh;
  Options options{.levels = 0, .view = View{.eye = {0, 0, 5}}};
  int asked = 0;
  const auto count = [&] { return ++asked < 0; };
  (void)refine(fine, options, {.cancelled = count});
  const int without = asked;
  options.simplify_hidden = true;
  asked = 0;
  EXPECT_LT(refine(fine, options, {.cancelled = count}).mesh.topology.face_count(), fine.topology.face_count());
  ASSERT_GT(asked, without + 1);
  int left = asked;
  EXPECT_THROW((void)refine(fine, options, {.cancelled = [&] { return --left == 0; }}), Error);
}

TEST(Refine, OptionsOutOfRangeAreRefused) {
  EXPECT_EQ(fault_of(icosahedron(), {.levels = -1}), Fault::bad_option);
  EXPECT_EQ(fault_of(icosahedron(), {.levels = 11}), Fault::bad_option);
  EXPECT_EQ(fault_of(icosahedron(), {.flatness = {0.5, 1.5}}), Fault::bad_option);
  EXPECT_EQ(fault_of(icosahedron(), {.flatness = {std::nan("")}}), Fault::bad_option);
  EXPECT_EQ(fault_of(icosahedron(), {.w = 1}), Fault::bad_option);
  EXPECT_EQ(fault_of(icosahedron(), {.crease_angle = 181}), Fault::bad_option);
  EXPECT_EQ(fault_of(icosahedron(), {.tolerance = -0.1}), Fault::bad_option);
  EXPECT_EQ(fault_of(icosahedron(), {.view = View{.error_pixels = -1}}), Fault::bad_option);
  EXPECT_EQ(fault_of(icosahedron(), {.view = View{.lights = {{0, 0, 0}}}}), Fault::bad_option);
}

}  // namespace
}  // namespace papilio
