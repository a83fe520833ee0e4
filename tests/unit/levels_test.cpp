#include "core/levels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"

// However much of a level is made for what a request wants to look into, below that it is what all of the level has.

namespace papilio {
namespace {

using namespace test;

/// This share of the faces, from one side of the mesh.
List<uint8_t> side_of(const Mesh& mesh, double share, Vec3d direction) {
  const Topology& topology = mesh.topology;
  std::vector<double> height(topology.face_count());
  for (uint32_t h = 0; h < topology.half_edge_count(); ++h)
    height[Topology::face(h)] += dot(direction, to_double(mesh.positions[topology.origin[h]]));
  std::vector<double> sorted = height;
  std::ranges::sort(sorted);
  const double least = sorted[static_cast<size_t>((1 - share) * static_cast<double>(sorted.size() - 1))];
  List<uint8_t> red(height.size());
  for (size_t f = 0; f < red.size(); ++f) red[f] = height[f] >= least ? 1 : 0;
  return red;
}

/// The children of red faces, of which either level may hold others too.
void expect_alike(const HierarchyLevel& some, const HierarchyLevel& all, const List<uint8_t>& red) {
  const Topology& topology = some.mesh.topology;
  for (uint32_t f = 0; f < red.size(); ++f) {
    if (red[f] == 0) continue;
    for (uint32_t i = 0; i < 12; ++i) {
      const uint32_t h = 3 * some.first_child_of(f) + i;
      const uint32_t h_of_all = 3 * all.first_child_of(f) + i;
      const uint32_t twin = all.mesh.topology.twin[h_of_all];
      ASSERT_EQ(some.mesh.positions[topology.origin[h]], all.mesh.positions[all.mesh.topology.origin[h_of_all]]);
      ASSERT_EQ(some.trial.normals[Topology::face(h)], all.trial.normals[Topology::face(h_of_all)]);
      if (twin != none && red[all.parent_of(Topology::face(twin))] == 0) continue;
      const uint32_t e = topology.edge[h];
      const uint32_t e_of_all = all.mesh.topology.edge[h_of_all];
      ASSERT_EQ(some.trial.at(e), all.trial.at(e_of_all));
      ASSERT_EQ(some.trial.deviation_at(some.mesh, e), all.trial.deviation_at(all.mesh, e_of_all));
    }
  }
}

struct Count {
  int whole = 0, part = 0;
};

void compare(const Mesh& coarse, const Options& options, std::mt19937& random, Count& count) {
  const Hooks hooks;
  const Progress progress(options, hooks);
  Levels all(coarse, options, progress);
  all.deepen(List<uint8_t>(coarse.topology.face_count(), 1));
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (double share : {0.05, 0.2, 0.4, 0.5, 0.6, 0.7, 0.95}) {
    const Vec3d direction{coordinate(random), coordinate(random), coordinate(random)};
    const List<uint8_t> red = side_of(coarse, share, direction);
    Levels some(coarse, options, progress);
    some.deepen(red);
    SCOPED_TRACE(std::to_string(share) + " of " + std::to_string(options.levels) + " levels");
    expect_alike(*some.deepest(), *all.deepest(), red);
    ++(some.deepest()->is_whole ? count.whole : count.part);
  }
}

TEST(Levels, AreBelowWhatIsRedAsWhereAllIs) {
  std::mt19937 random(5);
  Count count;
  for (const TriangleMesh& triangles : {real_mesh("bunny600.obj"), torus(12, 9), grid(9, 7), box({4, 4, 4}, {1, 1, 1})})
    for (int levels : {1, 2, 3})
      for (Tension tension : {Tension::off, Tension::soft})
        for (double w : {0.0, 0.02})
          for (double tolerance : {0.0, 1e-3})
            compare(build_mesh(triangles), {.levels = levels, .tension = tension, .w = w, .tolerance = tolerance},
                    random, count);
  EXPECT_GT(count.whole, 100);
  EXPECT_GT(count.part, 100);
}

}  // namespace
}  // namespace papilio
