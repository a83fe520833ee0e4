#include "core/hierarchy/levels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>

#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"

// Partial levels equal the whole level below the requested faces.

namespace papilio {
namespace {

using namespace test;

/// Marks this share of the faces, from one side of the mesh.
Buffer<uint8_t> side_of(const Mesh& mesh, double share, Vec3d direction) {
  const Topology& topology = mesh.topology;
  std::vector<double> height(topology.face_count());
  for (uint32_t h = 0; h < topology.half_edge_count(); ++h)
    height[Topology::face(h)] += dot(direction, to_double(mesh.positions[topology.origin[h]]));
  std::vector<double> sorted = height;
  std::ranges::sort(sorted);
  const double least = sorted[static_cast<size_t>((1 - share) * static_cast<double>(sorted.size() - 1))];
  Buffer<uint8_t> red(height.size());
  for (size_t f = 0; f < red.size(); ++f) red[f] = height[f] >= least ? 1 : 0;
  return red;
}

/// Compares the children of red faces; either level may have more. `in_all`: number of each face of the level above in
/// the whole level.
void expect_alike(const HierarchyLevel& some, const HierarchyLevel& all, const Buffer<uint8_t>& red,
                  const std::vector<uint32_t>& in_all) {
  const Topology& topology = some.mesh.topology;
  std::vector<uint8_t> red_in_all(all.mesh.topology.face_count() / 4);
  for (uint32_t f = 0; f < red.size(); ++f)
    if (red[f] != 0) red_in_all[in_all[f]] = 1;
  for (uint32_t f = 0; f < red.size(); ++f) {
    if (red[f] == 0) continue;
    for (uint32_t i = 0; i < 12; ++i) {
      const uint32_t h = 3 * some.first_child_of(f) + i;
      const uint32_t h_of_all = 3 * all.first_child_of(in_all[f]) + i;
      const uint32_t twin = all.mesh.topology.twin[h_of_all];
      ASSERT_EQ(some.mesh.positions[topology.origin[h]], all.mesh.positions[all.mesh.topology.origin[h_of_all]]);
      ASSERT_EQ(some.trial.normals[Topology::face(h)], all.trial.normals[Topology::face(h_of_all)]);
      if (twin != none && red_in_all[all.parent_of(Topology::face(twin))] == 0) continue;
      const uint32_t e = topology.edge[h];
      const uint32_t e_of_all = all.mesh.topology.edge[h_of_all];
      ASSERT_EQ(some.trial.at(e), all.trial.at(e_of_all));
      ASSERT_EQ(some.trial.deviation_at(some.mesh, e), all.trial.deviation_at(all.mesh, e_of_all));
    }
  }
}

/// Returns the number in the whole level of each face of a level.
std::vector<uint32_t> places_in_all(const HierarchyLevel& some, const HierarchyLevel& all) {
  std::vector<uint32_t> places(some.mesh.topology.face_count());
  for (uint32_t f = 0; f < places.size(); ++f) places[f] = all.first_child_of(some.parent_of(f)) + f % 4;
  return places;
}

/// Returns some of the faces that a request may divide next: they and their neighbours are children of red faces.
Buffer<uint8_t> some_below(const HierarchyLevel& level, const Buffer<uint8_t>& red, std::mt19937& random) {
  const Topology& topology = level.mesh.topology;
  const uint32_t density = 1 + random() % 3;
  const auto is_below_red = [&](uint32_t f) { return red[level.parent_of(f)] != 0; };
  Buffer<uint8_t> below(topology.face_count(), 0);
  for (uint32_t f = 0; f < below.size(); ++f) {
    bool may_be = is_below_red(f) && random() % density == 0;
    for (uint32_t h = 3 * f; h < 3 * f + 3; ++h)
      may_be = may_be && (topology.twin[h] == none || is_below_red(Topology::face(topology.twin[h])));
    below[f] = may_be ? 1 : 0;
  }
  return below;
}

void compare(const Mesh& coarse, const Options& options, std::mt19937& random, int& parts) {
  const Hooks hooks;
  const Progress progress(options, hooks);
  Levels all(coarse, options, progress);
  all.deepen(Buffer<uint8_t>(coarse.topology.face_count(), 1));
  const std::shared_ptr<const HierarchyLevel> all_of_first = all.deepest();
  if (options.levels > 2) all.deepen(Buffer<uint8_t>(all_of_first->mesh.topology.face_count(), 1));
  std::vector<uint32_t> in_all(coarse.topology.face_count());
  std::iota(in_all.begin(), in_all.end(), 0U);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (double share : {0.05, 0.2, 0.4, 0.5, 0.6, 0.7, 0.95}) {
    const Vec3d direction{coordinate(random), coordinate(random), coordinate(random)};
    const Buffer<uint8_t> red = side_of(coarse, share, direction);
    Levels some(coarse, options, progress);
    some.deepen(red);
    SCOPED_TRACE(std::to_string(share) + " of " + std::to_string(options.levels) + " levels");
    const std::shared_ptr<const HierarchyLevel> first = some.deepest();
    expect_alike(*first, *all_of_first, red, in_all);
    parts += first->is_whole ? 0 : 1;
    if (options.levels <= 2) continue;
    const Buffer<uint8_t> red_below = some_below(*first, red, random);
    if (std::ranges::find(red_below, 1) == red_below.end()) continue;
    some.deepen(red_below);
    expect_alike(*some.deepest(), *all.deepest(), red_below, places_in_all(*first, *all_of_first));
  }
}

TEST(Levels, PartialLevelsEqualWholeLevels) {
  std::mt19937 random(5);
  int parts = 0;
  for (const TriangleMesh& triangles : {real_mesh("bunny600.obj"), torus(12, 9), grid(9, 7), box({4, 4, 4}, {1, 1, 1})})
    for (int levels : {1, 2, 3, 4})
      for (Tension tension : {Tension::off, Tension::soft})
        for (double w : {0.0, 0.02})
          for (double tolerance : {0.0, 1e-3})
            compare(build_mesh(triangles), {.levels = levels, .tension = tension, .w = w, .tolerance = tolerance},
                    random, parts);
  EXPECT_GT(parts, 100);
}

}  // namespace
}  // namespace papilio
