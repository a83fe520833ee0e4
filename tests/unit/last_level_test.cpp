#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

#include "core/features.h"
#include "core/flatness.h"
#include "core/hierarchy.h"
#include "core/level_choice.h"
#include "core/normals.h"
#include "core/refine.h"
#include "core/selection.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"

// The last level of a request holds the children of what is red and nothing else. Where it holds something, that is
// what the level has of which all faces are held.

namespace papilio {
namespace {

using namespace test;

/// Closed meshes without creases whose vertices are shaken, tried.
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
    level->trial = try_everything(level->mesh, options, {.features = &level->features});
    levels.push_back(level);
  }
  return levels;
}

List<uint8_t> random_faces(const Topology& mesh, std::mt19937& random) {
  List<uint8_t> red(mesh.face_count());
  for (uint8_t& is_red : red) is_red = random() % 3 == 0 ? 1 : 0;
  red[random() % red.size()] = 1;
  return red;
}

template <class Numbers>
void expect_same(const Numbers& some, const Numbers& all, size_t first, size_t count) {
  ASSERT_EQ(some.size(), all.size());
  for (size_t i = first; i < first + count; ++i) ASSERT_EQ(some[i], all[i]) << i;
}

TEST(LastLevel, HasWhatTheWholeLevelHas) {
  std::mt19937 random(1);
  for (int round = 0; round < 10; ++round)
    for (const auto& above : ring_levels(random)) {
      const Topology& mesh = above->mesh.topology;
      const List<uint8_t> red = random_faces(mesh, random);
      const HierarchyLevel whole = refine_level(*above, List<uint8_t>(red.size(), 1)).level;
      ASSERT_TRUE(whole.is_whole);
      const HierarchyLevel last = refine_last_level(*above, red, marked(red));
      EXPECT_FALSE(last.is_whole);
      EXPECT_EQ(last.red, red);
      EXPECT_EQ(last.mesh.positions, whole.mesh.positions);
      EXPECT_EQ(last.features.spokes, whole.features.spokes);
      const Topology& some = last.mesh.topology;
      const Topology& all = whole.mesh.topology;
      EXPECT_EQ(some.vertex_count, all.vertex_count);
      const uint32_t inner = 2 * mesh.edge_count();
      expect_same(some.half_edge, all.half_edge, 0, inner);
      expect_same(some.kind, all.kind, 0, inner);
      Array<Vec3f> held;
      for (uint32_t f : marked(red)) {
        for (uint32_t c = 0; c < 4; ++c) EXPECT_EQ(last.parent_of(4 * f + c), f);
        EXPECT_EQ(last.first_child_of(f), 4 * f);
        expect_same(some.origin, all.origin, 12 * f, 12);
        expect_same(some.twin, all.twin, 12 * f, 12);
        expect_same(some.edge, all.edge, 12 * f, 12);
        expect_same(some.half_edge, all.half_edge, inner + 3 * f, 3);
        expect_same(some.kind, all.kind, inner + 3 * f, 3);
        for (uint32_t h = 12 * f; h < 12 * f + 12; ++h) held.push_back(last.mesh.positions[some.origin[h]]);
      }
      held.push_back(above->box.min);  // the box is that of these
      held.push_back(above->box.max);
      const Box box = bounding_box(held);
      EXPECT_EQ(last.box.min, box.min);
      EXPECT_EQ(last.box.max, box.max);
    }
}

TEST(LastLevel, ItsRegionIsThatOfAnyLevel) {
  std::mt19937 random(2);
  for (int round = 0; round < 10; ++round)
    for (const auto& above : ring_levels(random)) {
      const List<uint8_t> red = random_faces(above->mesh.topology, random);
      LevelChoice choice = choose_coarsest(above);
      EXPECT_FALSE(choice.region.is_in_fours);
      mark_red(choice, marked(red));
      const LevelChoice in_last =
          choose_below(choice, std::make_shared<HierarchyLevel>(refine_last_level(*above, red, marked(red))));
      const LevelChoice in_part =
          choose_below(choice, std::make_shared<HierarchyLevel>(refine_level(*above, red).level));
      for (const LevelChoice* below : {&in_last, &in_part}) {
        EXPECT_TRUE(below->region.is_in_fours);
        EXPECT_EQ(below->region.faces.size(), 4 * marked(red).size());
        EXPECT_EQ(below->region.edges, marked(below->region.has_edge));
      }
      // Numbers differ, but not what they stand for.
      const auto ends = [](const LevelChoice& below) {
        std::vector<std::array<Vec3f, 2>> all;
        const Mesh& mesh = below.level->mesh;
        for (uint32_t e : below.region.edges) {
          const uint32_t h = mesh.topology.half_edge[e];
          all.push_back({mesh.positions[mesh.topology.origin[h]], mesh.positions[mesh.topology.tip(h)]});
        }
        return all;
      };
      EXPECT_EQ(ends(in_last), ends(in_part));
    }
}

TEST(LastLevel, FlatnessOfFoursIsThatOfFaces) {
  std::mt19937 random(3);
  size_t curved = 0;
  size_t flat = 0;
  for (int round = 0; round < 10; ++round)
    for (const auto& above : ring_levels(random)) {
      HierarchyLevel level = refine_level(*above, List<uint8_t>(above->mesh.topology.face_count(), 1)).level;
      Topology& topology = level.mesh.topology;
      if (round % 2 == 1)
        for (int i = 0; i < 5; ++i) topology.kind[random() % topology.edge_count()] = EdgeKind::crease;
      Array<Vec3f> normals = face_normals(level.mesh);
      for (int i = 0; i < 5; ++i) normals[random() % normals.size()] = {};
      Region region = whole_region(topology);
      const auto find = [&](bool in_fours) {
        region.is_in_fours = in_fours;
        return find_curved(level.mesh, normals, {}, 0.95, region);
      };
      const EdgeMarks of_faces = find(false);
      EXPECT_EQ(find(true), of_faces);
      const NormalProducts kept(topology.edge_count(), std::numeric_limits<float>::infinity());
      EXPECT_EQ(find_curved(level.mesh, normals, kept, 0.95, region), of_faces) << "edge by edge";
      EXPECT_EQ(find_curved(level.mesh, normals, kept, 0.95, region), of_faces) << "from what is known";
      for (uint8_t mark : of_faces) ++(mark != 0 ? curved : flat);
    }
  EXPECT_GT(curved, 1000U);
  EXPECT_GT(flat, 1000U);
}

/// Where errors do not decide, what one level more adds lies behind what was there.
void expect_more_of_the_same(const Mesh& coarse, Options options) {
  Array<Vec3f> above;
  for (options.levels = 1; options.levels <= 3; ++options.levels) {
    const Mesh mesh = refine(coarse, options).mesh;
    ASSERT_GE(mesh.positions.size(), above.size());
    ASSERT_TRUE(std::ranges::equal(above, std::span(mesh.positions).first(above.size()))) << options.levels;
    above = mesh.positions;
  }
}

TEST(LastLevel, ChangesNothingAbove) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> shake(-0.1F, 0.1F);
  for (int round = 0; round < 40; ++round) {
    TriangleMesh shape = random_manifold(random);
    for (Vec3f& p : shape.positions) p += Vec3f{shake(random), shake(random), shake(random)};
    expect_more_of_the_same(build_mesh(shape), {.flatness = {0.9}, .crease_angle = round % 3 == 0 ? 40.0 : 180.0});
  }
  // Dividing one face can make a sliver of another, or of none what was one.
  const Mesh elephant = build_mesh(real_mesh("elephant2k.drc"));
  for (double threshold = 0.7; threshold < 0.85; threshold += 0.002)
    expect_more_of_the_same(elephant, {.flatness = {threshold}, .tension = Tension::off});
}

}  // namespace
}  // namespace papilio
