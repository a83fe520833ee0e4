#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <functional>

#include "core/criteria/camera.h"
#include "core/simplify/simplify.h"
#include "proto/draco_reader.h"
#include "proto/draco_writer.h"
#include "tests/support/crowded_meshes.h"

// Work on meshes with many faces at one vertex or edge is near-linear.

namespace papilio::proto {
namespace {

using namespace test;

constexpr uint32_t few = 15'000;

/// Returns the thread's CPU time of the fastest of some runs.
double processor_seconds(const std::function<void()>& work) {
  double least = 1e9;
  for (int i = 0; i < 3; ++i) {
    timespec begin{};
    timespec end{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
    work();
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
    least = std::min(least, static_cast<double>(end.tv_sec - begin.tv_sec) +
                                1e-9 * static_cast<double>(end.tv_nsec - begin.tv_nsec));
  }
  return least;
}

/// Expects near-linear `work`, whose inputs are made beforehand: four times the faces take about four times as long;
/// quadratic work would take 16 times.
void expect_near_linear(const std::function<std::function<void()>(uint32_t)>& work, uint32_t faces = few) {
  const double one = processor_seconds(work(faces));
  const double four = processor_seconds(work(4 * faces));
  EXPECT_LT(four / one, 10) << one << " and " << four << " seconds";
}

using Make = TriangleMesh (*)(uint32_t);
constexpr Make crowded[] = {faces_at_one_edge, triangles_at_one_vertex, shuffled_cone};

TEST(Growth, EncodingCrowdedMeshesIsNearLinear) {
  for (const Make make : crowded)
    for (int speed : {0, 1, 3, 7})
      expect_near_linear([&](uint32_t faces) {
        return [mesh = build_mesh(make(faces)), speed] {
          (void)write_draco(mesh, quantization_box(mesh.positions), {.speed = speed});
        };
      });
}

// At speeds below 5 the encoder also duplicates a vertex at each split symbol.
TEST(Growth, EncodingAMeshOfManySplitsIsNearLinear) {
  const auto encode = [&](uint32_t faces) {
    return [mesh = build_mesh(read_draco(merging_stream(faces / 4), {}))] {
      (void)write_draco(mesh, quantization_box(mesh.positions), {.speed = 3});
    };
  };
  expect_near_linear(encode, 4'000);
}

TEST(Growth, EncodingCrowdedMeshesExactlyAndDecodingThemIsNearLinear) {
  for (const Make make : crowded)
    expect_near_linear(
        [&](uint32_t faces) { return [mesh = make(faces)] { (void)read_draco(write_draco_exact(mesh), {}); }; });
}

TEST(Growth, SimplifyingAFanThatFacesAwayIsNearLinear) {
  View view;
  view.eye = {0, 0, -3};
  const Camera camera(view);
  expect_near_linear([&](uint32_t faces) {
    return [&, mesh = build_mesh(shuffled_cone(faces))] { (void)simplify_hidden(mesh, camera); };
  });
}

}  // namespace
}  // namespace papilio::proto
