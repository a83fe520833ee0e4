#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

#include "core/criteria/flatness.h"
#include "core/criteria/selection.h"
#include "core/hierarchy/hierarchy.h"
#include "core/hierarchy/level_choice.h"
#include "core/mesh/normals.h"
#include "core/mesh/part.h"
#include "core/rules/features.h"
#include "papilio/refine.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"

// The last level of a request has only the children of red faces. They equal the children in the whole level.

namespace papilio {
namespace {

using namespace test;

/// Closed meshes without creases, with jittered vertices and tried splits.
std::vector<std::shared_ptr<HierarchyLevel>> ring_levels(std::mt19937& random) {
  std::vector<TriangleMesh> shapes{tetrahedron(),
                                   icosahedron(),
                                   torus(9, 6),
                                   bipyramid(20),
                                   box({3, 2, 2}, {3, 2, 1}),
                                   join(icosahedron(), torus(5, 4), 4)};
  std::uniform_real_distribution<float> shake(-0.1F, 0.1F);
  std::vector<std::shared_ptr<HierarchyLevel>> levels;
  for (TriangleMesh& shape : shapes) {
    for (Vec3f& p : shape.positions) p += Vec3f{shake(random), shake(random), shake(random)};
    const auto level = std::make_shared<HierarchyLevel>(coarsest_level(build_mesh(shape)));
    EXPECT_TRUE(level->features.are_rings());
    const Options options{.tension = Tension::off};
    level->trial = try_split(level->mesh, options, {.features = &level->features});
    levels.push_back(level);
  }
  return levels;
}

Buffer<uint8_t> random_faces(const Topology& mesh, std::mt19937& random) {
  Buffer<uint8_t> red(mesh.face_count());
  for (uint8_t& is_red : red) is_red = random() % 3 == 0 ? 1 : 0;
  red[random() % red.size()] = 1;
  return red;
}

/// Map from the numbers of the last level to those of the whole level.
class SomeOfAll {
 public:
  SomeOfAll(const Topology& above, const Buffer<uint8_t>& red, const Part& part, const HierarchyLevel& last)
      : red_(red), part_(part), last_(last), inner_edges_of_all_(2 * above.edge_count()) {}

  /// Return the numbers in the whole level.
  [[nodiscard]] uint32_t half_edge(uint32_t h) const { return 12 * last_.parent_of(Topology::face(h)) + h % 12; }
  [[nodiscard]] uint32_t edge(uint32_t e) const {
    const uint32_t halves = 2 * part_.edges.count() + 2;
    if (e < halves) return 2 * part_.edges.numbers()[e / 2] + e % 2;
    return inner_edges_of_all_ + 3 * part_.faces.numbers()[(e - halves) / 3] + (e - halves) % 3;
  }
  /// Return whether a half-edge is outside of the part: of the last level, and of the whole level.
  [[nodiscard]] bool is_other(uint32_t h) const { return h / 12 == part_.other_face(); }
  [[nodiscard]] bool is_left_out(uint32_t h_of_all) const { return red_[h_of_all / 12] == 0; }

 private:
  const Buffer<uint8_t>& red_;
  const Part& part_;
  const HierarchyLevel& last_;
  uint32_t inner_edges_of_all_;
};

TEST(LastLevel, PartialLevelEqualsTheWholeWhereItIsBuilt) {
  std::mt19937 random(1);
  for (int round = 0; round < 10; ++round)
    for (const auto& above : ring_levels(random)) {
      const Buffer<uint8_t> red = random_faces(above->mesh.topology, random);
      const HierarchyLevel whole = refine_level(*above, Buffer<uint8_t>(red.size(), 1)).level;
      ASSERT_TRUE(whole.is_whole);
      const Part part(above->mesh.topology, red);
      const HierarchyLevel last = refine_last_level(*above, red, part);
      EXPECT_FALSE(last.is_whole);
      EXPECT_EQ(last.red, red);
      EXPECT_EQ(last.mesh.positions, whole.mesh.positions);
      const Topology& some = last.mesh.topology;
      const Topology& all = whole.mesh.topology;
      EXPECT_EQ(some.vertex_count, all.vertex_count);
      EXPECT_EQ(some.face_count(), 4 * part.faces.count() + 4);
      EXPECT_EQ(some.edge_count(), 2 * part.edges.count() + 2 + 3 * (part.faces.count() + 1));
      const SomeOfAll of_all(above->mesh.topology, red, part, last);
      size_t held = 0;
      for (uint32_t h = 0; h < some.half_edge_count(); ++h) {
        ASSERT_LT(some.twin[h], some.half_edge_count());
        ASSERT_LT(some.origin[h], some.vertex_count);
        ASSERT_LT(some.edge[h], some.edge_count());
        if (of_all.is_other(h)) continue;
        ++held;
        const uint32_t same = of_all.half_edge(h);
        ASSERT_EQ(last.first_child_of(same / 12), 4 * (h / 12));
        ASSERT_EQ(some.origin[h], all.origin[same]);
        ASSERT_EQ(of_all.edge(some.edge[h]), all.edge[same]);
        ASSERT_EQ(of_all.is_other(some.twin[h]), of_all.is_left_out(all.twin[same]));
        if (!of_all.is_other(some.twin[h])) {
          ASSERT_EQ(of_all.half_edge(some.twin[h]), all.twin[same]);
        }
      }
      EXPECT_EQ(held, 12 * marked(red).size());
      for (uint32_t e = 0; e < some.edge_count(); ++e) {
        const uint32_t h = some.half_edge[e];
        ASSERT_EQ(some.edge[h], e);
        ASSERT_EQ(some.kind[e], EdgeKind::smooth);
        if (of_all.is_other(h)) continue;
        const uint32_t named = all.half_edge[of_all.edge(e)];
        ASSERT_EQ(of_all.half_edge(h), of_all.is_left_out(named) ? all.twin[named] : named);
      }
    }
}

TEST(LastLevel, VerticesEqualTheWholeLevelsAndTheBoxBoundsThem) {
  std::mt19937 random(5);
  const Options options{.tension = Tension::off};
  size_t between = 0;
  for (int round = 0; round < 10; ++round)
    for (const auto& above : ring_levels(random)) {
      const Topology& mesh = above->mesh.topology;
      const Buffer<uint8_t> red = random_faces(mesh, random);
      const HierarchyLevel whole = refine_level(*above, Buffer<uint8_t>(red.size(), 1)).level;
      const Part part(mesh, red);
      const HierarchyLevel last = refine_last_level(*above, red, part);
      const SomeOfAll of_all(mesh, red, part, last);
      const Trial all = try_split(whole.mesh, options, {.features = &whole.features});
      const Trial some = try_split(last.mesh, options, {.features = &above->features, .parents = &mesh, .part = &part});
      const Topology& topology = last.mesh.topology;
      for (uint32_t h = 0; h < topology.half_edge_count(); ++h) {
        if (of_all.is_other(h) || of_all.is_other(topology.twin[h])) continue;
        ++between;
        ASSERT_EQ(some.at(topology.edge[h]), all.at(of_all.edge(topology.edge[h])));
      }
      Buffer<Vec3f> points{above->box.min, above->box.max};
      for (uint32_t f : last.parent)
        for (uint32_t i = 0; f != none && i < 3; ++i) points.push_back(above->trial.made[mesh.edge[3 * f + i]]);
      const Box box = bounding_box(points);
      EXPECT_EQ(last.box.min, box.min);
      EXPECT_EQ(last.box.max, box.max);
    }
  EXPECT_GT(between, 5000U);
}

TEST(LastLevel, RegionEqualsThatOfAPartialLevel) {
  std::mt19937 random(2);
  for (int round = 0; round < 10; ++round)
    for (const auto& above : ring_levels(random)) {
      const Buffer<uint8_t> red = random_faces(above->mesh.topology, random);
      LevelChoice choice = choose_coarsest(above);
      mark_red(choice, marked(red));
      const LevelChoice in_last = choose_below(
          choice, std::make_shared<HierarchyLevel>(refine_last_level(*above, red, Part(above->mesh.topology, red))));
      const LevelChoice in_part =
          choose_below(choice, std::make_shared<HierarchyLevel>(refine_level(*above, red).level));
      for (const LevelChoice* below : {&in_last, &in_part})
        EXPECT_EQ(below->region.faces.size(), 4 * marked(red).size());
      // Numbers differ, but the positions are equal.
      const auto ends = [](const LevelChoice& below) {
        std::vector<std::array<Vec3f, 2>> all;
        const Mesh& mesh = below.level->mesh;
        for (uint32_t e : below.region.edges()) {
          const uint32_t h = mesh.topology.half_edge[e];
          all.push_back({mesh.positions[mesh.topology.origin[h]], mesh.positions[mesh.topology.tip(h)]});
        }
        return all;
      };
      EXPECT_EQ(ends(in_last), ends(in_part));
    }
}

}  // namespace
}  // namespace papilio
