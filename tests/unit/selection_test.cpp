#include "core/criteria/selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "client/lib/compare.h"
#include "core/criteria/camera.h"
#include "papilio/refine.h"
#include "tests/support/invariants.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

uint32_t faces_of(const Result& result) { return result.mesh.topology.face_count(); }

TEST(Deviation, DeviationIsTheDistanceToTheFacesAtTheEdge) {
  const Mesh roof = build_mesh({{{0, 0, 0}, {2, 0, 0}, {1, 2, 0}, {1, -1, 1}}, {{0, 1, 2}, {1, 0, 3}}});
  uint32_t ridge = none;
  for (uint32_t e = 0; e < roof.topology.edge_count(); ++e)
    if (roof.topology.kind[e] == EdgeKind::smooth) ridge = e;
  ASSERT_NE(ridge, none);
  EXPECT_NEAR(deviation(roof, ridge, {1, 0.2F, 0.3F}), 0.3, 1e-6);  // above the flat face: sliding does not count
  EXPECT_NEAR(deviation(roof, ridge, {1, 0.5F, 0}), 0, 1e-12);
  EXPECT_NEAR(deviation(roof, ridge, {1, 0, -0.5F}), 0.5, 1e-6);
  for (uint32_t e = 0; e < roof.topology.edge_count(); ++e) {
    if (e == ridge) continue;  // at a boundary sliding moves the outline
    const uint32_t h = roof.topology.half_edge[e];
    const Vec3f middle = 0.5F * (roof.positions[roof.topology.origin[h]] + roof.positions[roof.topology.tip(h)]);
    EXPECT_NEAR(deviation(roof, e, middle), 0, 1e-6);
    const Vec3f inward = roof.positions[roof.topology.apex(h)] - middle;
    EXPECT_GT(deviation(roof, e, middle + 0.1F * inward), 0.01);
  }
}

TEST(Tolerance, ToleranceIsReachedAndReported) {
  const Mesh coarse = build_mesh(icosahedron());
  for (Scheme scheme : {Scheme::red_green, Scheme::in_place}) {
    uint32_t before = 0;
    for (double tolerance : {0.03, 0.01, 0.003, 0.001}) {
      const Result result = refine(coarse, {.levels = 8, .scheme = scheme, .tolerance = tolerance});
      EXPECT_EQ(result.stop_reason, StopReason::converged);
      EXPECT_LT(result.error, tolerance);
      EXPECT_GT(faces_of(result), before);
      before = faces_of(result);
      const Mesh limit = refine(coarse, {.levels = 5}).mesh;
      const client::Comparison apart = client::compare(limit.triangles(), result.mesh.triangles(), {.samples = 0});
      EXPECT_LE(apart.max_forward / bounding_box(coarse.positions).diagonal(), 2 * tolerance);
    }
  }
}

TEST(Tolerance, FlatRegionsAreNotSplit) {
  // A flat sheet of irregular triangles: new vertices are off the midpoints, but in the plane.
  TriangleMesh sheet = fan(7, true);
  for (Scheme scheme : {Scheme::red_green, Scheme::in_place}) {
    const Mesh coarse = refine(build_mesh(sheet), {.levels = 2}).mesh;  // with a smooth curved boundary
    const Result result = refine(coarse, {.levels = 1, .scheme = scheme, .tolerance = 0.02});
    EXPECT_EQ(faces_of(result), coarse.topology.face_count());
    EXPECT_EQ(result.stop_reason, StopReason::converged);
  }
}

TEST(Tolerance, ToleranceReducesTheSplitsOfFlatness) {
  const Mesh bunny = build_mesh(real_mesh("bunny600.obj"));
  for (Scheme scheme : {Scheme::red_green, Scheme::in_place}) {
    const Options flat{.levels = 2, .scheme = scheme, .flatness = {0.8, 0.9}};
    Options both = flat;
    both.tolerance = 2e-3;
    EXPECT_LT(faces_of(refine(bunny, both)), faces_of(refine(bunny, flat)));
  }
}

/// A wave whose middle new vertices are the coarse midpoints: deviations at level 0 do not reveal it.
TEST(Tolerance, ToleranceHoldsBelowEdgesThatDoNotMove) {
  TriangleMesh sheet = grid(12, 4);
  const std::array<float, 13> wave{0, 0, 0, 0, 1, 2, 3, 4, 4, 4, 4, 4, 4};
  for (Vec3f& p : sheet.positions) p.z = wave[static_cast<size_t>(p.x)];
  const Mesh coarse = build_mesh(sheet);
  const Result result = refine(coarse, {.levels = 4, .tension = Tension::off, .tolerance = 1e-4});
  const Result uniform = refine(coarse, {.levels = 4, .tension = Tension::off});
  const double apart = client::compare(uniform.mesh.triangles(), result.mesh.triangles(), {.samples = 0}).max_forward;
  EXPECT_LE(apart / bounding_box(coarse.positions).diagonal(), 3e-4);
  EXPECT_LT(faces_of(result), faces_of(uniform) / 2);
}

View front(const Mesh& mesh, double distance) {
  const Box box = bounding_box(mesh.positions);
  View view;
  view.target = 0.5 * (to_double(box.min) + to_double(box.max));
  view.eye = view.target + Vec3d{0, 0, distance * box.diagonal()};
  view.edge_pixels = 0;
  return view;
}

TEST(Tolerance, StopReasonIsConvergedExactlyIfTheRequestedErrorIsReached) {
  const Mesh bunny = build_mesh(real_mesh("bunny600.obj"));
  for (Scheme scheme : {Scheme::red_green, Scheme::in_place})
    for (int levels = 1; levels <= 4; ++levels)
      for (double tolerance : {0.02, 0.001, 1e-5}) {
        SCOPED_TRACE(std::to_string(levels) + " " + std::to_string(tolerance));
        Options options{.levels = levels, .scheme = scheme, .tolerance = tolerance};
        const Result result = refine(bunny, options);
        EXPECT_EQ(result.stop_reason, result.error <= tolerance ? StopReason::converged : StopReason::levels);
        options.view = front(bunny, 1);
        options.view->error_pixels = 1000 * tolerance;
        options.tolerance = 0;
        const Result seen = refine(bunny, options);
        EXPECT_EQ(seen.stop_reason, seen.error_pixels <= 1000 * tolerance ? StopReason::converged : StopReason::levels);
        options.measure_error = false;  // then nobody can tell
        EXPECT_EQ(refine(bunny, options).levels == levels, refine(bunny, options).stop_reason == StopReason::levels);
      }
  EXPECT_EQ(refine(bunny, {.levels = 3, .tolerance = 1e-3}).stop_reason, StopReason::converged);
}

TEST(ErrorPixels, NearerPartsAreFiner) {
  const Mesh bunny = build_mesh(real_mesh("bunny600.obj"));
  for (Scheme scheme : {Scheme::red_green, Scheme::in_place}) {
    for (Projection projection : {Projection::perspective, Projection::orthographic}) {
      Options options{.levels = 4, .scheme = scheme};
      std::vector<uint32_t> faces;
      for (double distance : {1.0, 2.0, 4.0, 8.0}) {
        options.view = front(bunny, distance);
        options.view->error_pixels = 1;
        options.view->projection = projection;
        const Result result = refine(bunny, options);
        faces.push_back(faces_of(result));
        EXPECT_GT(result.error_pixels, 0);
        EXPECT_GT(result.error, 0);
        if (result.stop_reason == StopReason::converged) {
          EXPECT_LT(result.error_pixels, 1);
        }
      }
      EXPECT_TRUE(std::ranges::is_sorted(faces, std::greater()));
      EXPECT_GT(faces.front(), 2 * faces.back());
    }
  }
}

TEST(ErrorPixels, ErrorIncludesEdgesTooShortToBeSplit) {
  View view;
  view.eye = {0, 0, 30};
  view.edge_pixels = 1000;
  for (Scheme scheme : {Scheme::red_green, Scheme::in_place}) {
    const Result result = refine(build_mesh(icosahedron()), {.levels = 3, .scheme = scheme, .view = view});
    EXPECT_EQ(faces_of(result), 20U);
    EXPECT_GT(result.error, 0.01);
    EXPECT_GT(result.error_pixels, 1);
  }
}

TEST(ErrorPixels, ErrorEqualsTheCamerasPixels) {
  View view;
  view.eye = {0, 0, 10};
  view.fov_y = 90;
  view.viewport = {200, 100};
  const Camera camera(view);
  EXPECT_NEAR(camera.pixels_per_unit({0, 0, 0}), 5, 1e-9);  // 100 pixels are 20 units at distance 10
  EXPECT_NEAR(camera.pixels_per_unit({3, 1, 5}), 10, 1e-9);
  EXPECT_NEAR(camera.pixels_per_unit({0, 0, 20}), 50 / 0.01, 1e-6);  // behind the eye: clamped to the near plane
  view.projection = Projection::orthographic;
  EXPECT_NEAR(Camera(view).pixels_per_unit({0, 0, -50}), 5, 1e-9);
}

TEST(Budget, LargerBudgetsAreKeptAndLowerTheError) {
  for (const char* name : {"bunny600.obj", "cgal/rotor_small.off"}) {
    const Mesh coarse = build_mesh(real_mesh(name));
    const uint32_t least = coarse.topology.face_count();
    for (Scheme scheme : {Scheme::red_green, Scheme::in_place}) {
      uint32_t before = 0;
      double error_before = 1;
      for (double times : {1.0, 1.001, 1.01, 1.1, 1.5, 2.0, 4.0, 7.0}) {
        Options options{.levels = 3, .scheme = scheme};
        options.max_faces = static_cast<uint64_t>(times * least);
        const Result result = refine(coarse, options, {.on_level = [&](const Level& level) {
                                       ASSERT_LE(level.mesh.topology.face_count(), options.max_faces);
                                       ASSERT_TRUE(is_consistent(level.mesh));
                                     }});
        EXPECT_EQ(result.stop_reason, StopReason::budget);
        EXPECT_GE(faces_of(result), before);
        if (scheme == Scheme::red_green) {
          EXPECT_LE(result.error, error_before * 1.0001);
          EXPECT_GE(faces_of(result), 0.99 * static_cast<double>(options.max_faces)) << "the budget is used";
        }
        before = faces_of(result);
        error_before = result.error;
      }
    }
  }
}

TEST(Budget, AmpleBudgetChangesNothing) {
  const Mesh bunny = build_mesh(real_mesh("bunny600.obj"));
  for (Scheme scheme : {Scheme::red_green, Scheme::in_place}) {
    Options options{.levels = 3, .scheme = scheme, .tolerance = 1e-3};
    const Result without = refine(bunny, options);
    options.max_faces = faces_of(without);
    const Result with = refine(bunny, options);
    EXPECT_EQ(with.mesh.triangles(), without.mesh.triangles());
    EXPECT_NE(with.stop_reason, StopReason::budget);
    options.max_faces = faces_of(without) / 2;
    const Result less = refine(bunny, options);
    EXPECT_LE(faces_of(less), options.max_faces);
    EXPECT_GT(less.error, options.tolerance);
    EXPECT_EQ(less.stop_reason, StopReason::budget);
  }
}

TEST(Budget, LevelCallbacksDoNotChangeTheResult) {
  for (uint32_t seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    const Mesh coarse = build_mesh(random_manifold(random));
    const uint32_t least = coarse.topology.face_count();
    for (double times : {1.1, 1.3, 1.7, 2.2, 2.8}) {
      const Options options{.levels = 3, .max_faces = static_cast<uint64_t>(times * least)};
      const Result result = refine(coarse, options);
      const Result seen = refine(coarse, options, {.on_level = [](const Level&) {}});
      ASSERT_EQ(result.mesh.triangles(), seen.mesh.triangles()) << seed;
      ASSERT_EQ(result.error, seen.error) << seed;
      ASSERT_EQ(result.levels > 0, faces_of(result) > least) << seed;
      Options shallow = options;
      shallow.levels = 1;
      ASSERT_EQ(faces_of(refine(coarse, shallow)) > least, faces_of(result) > least)
          << seed << ": more levels are coarser";
    }
  }
}

TEST(Budget, HugeErrorsDoNotExceedTheBudget) {
  const Mesh coarse = build_mesh(icosahedron());
  const Topology& mesh = coarse.topology;
  View view;
  view.eye = 0.5 * (to_double(coarse.positions[mesh.origin[0]]) + to_double(coarse.positions[mesh.origin[1]]));
  view.target = view.eye - Vec3d{0, 0, 1};
  view.fov_y = 0.01;
  view.viewport = {1e6, 1e6};
  view.edge_pixels = 0;
  for (double near : {1e-30, 1e-300}) {
    view.near = near;
    for (Scheme scheme : {Scheme::red_green, Scheme::in_place}) {
      const Result result = refine(coarse, {.levels = 3, .scheme = scheme, .view = view, .max_faces = 25});
      EXPECT_LE(faces_of(result), 25U);
      EXPECT_TRUE(std::isfinite(result.error_pixels));
    }
  }
}

TEST(Budget, BudgetBelowTheCoarseMeshIsRefused) {
  try {
    (void)refine(build_mesh(icosahedron()), {.max_faces = 19});
    FAIL() << "was not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::result_too_large);
    EXPECT_NE(std::string(error.what()).find("20 faces"), std::string::npos);
  }
}

TEST(Budget, ManyLevelsDoNotExceedTheBudget) {
  // Ten uniform levels would be 21 million faces: exploration is bounded by the budget.
  const Result result = refine(build_mesh(icosahedron()), {.levels = 10, .max_faces = 3000});
  EXPECT_LE(faces_of(result), 3000U);
  EXPECT_EQ(result.stop_reason, StopReason::budget);
}

TEST(Selection, EyeInsideTheMeshIsAccepted) {
  // The eye is inside the mesh: parts behind the near plane are neither refined nor an error.
  const Mesh bunny = build_mesh(real_mesh("bunny600.obj"));
  View view = front(bunny, 0.1);
  view.error_pixels = 2;
  for (Scheme scheme : {Scheme::red_green, Scheme::in_place}) {
    const Result result = refine(bunny, {.levels = 3, .scheme = scheme, .view = view});
    EXPECT_TRUE(is_consistent(result.mesh));
    EXPECT_LT(faces_of(result), 600U * 64);
  }
}

}  // namespace
}  // namespace papilio
