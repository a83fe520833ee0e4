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

/// The last level beside all of that level, whose numbers are other ones.
class SomeOfAll {
 public:
  SomeOfAll(const Topology& above, const Buffer<uint8_t>& red, const Part& part, const HierarchyLevel& last)
      : red_(red), part_(part), last_(last), inner_edges_of_all_(2 * above.edge_count()) {}

  /// Where these are in the whole level.
  [[nodiscard]] uint32_t half_edge(uint32_t h) const { return 12 * last_.parent_of(Topology::face(h)) + h % 12; }
  [[nodiscard]] uint32_t edge(uint32_t e) const {
    const uint32_t halves = 2 * part_.edges.count() + 2;
    if (e < halves) return 2 * part_.edges.numbers()[e / 2] + e % 2;
    return inner_edges_of_all_ + 3 * part_.faces.numbers()[(e - halves) / 3] + (e - halves) % 3;
  }
  /// Whether these are not in the part: one of the last level, one of the whole.
  [[nodiscard]] bool is_other(uint32_t h) const { return h / 12 == part_.other_face(); }
  [[nodiscard]] bool is_left_out(uint32_t h_of_all) const { return red_[h_of_all / 12] == 0; }

 private:
  const Buffer<uint8_t>& red_;
  const Part& part_;
  const HierarchyLevel& last_;
  uint32_t inner_edges_of_all_;
};

TEST(LastLevel, HasWhatTheWholeLevelHas) {
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

TEST(LastLevel, HasTheVerticesOfTheLevelAndABoxRoundItsOwn) {
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

TEST(LastLevel, ItsRegionIsThatOfAnyLevel) {
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
      // Numbers differ, but not what they stand for.
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

TEST(LastLevel, FlatnessIsTheSameByFacesAndByEdges) {
  std::mt19937 random(3);
  size_t curved = 0;
  size_t flat = 0;
  for (int round = 0; round < 12; ++round)
    for (const auto& above : ring_levels(random)) {
      const Buffer<uint8_t> red = random_faces(above->mesh.topology, random);
      LevelChoice choice = choose_coarsest(above);
      mark_red(choice, marked(red));
      const auto level = std::make_shared<HierarchyLevel>(refine_level(*above, red).level);
      Topology& topology = level->mesh.topology;
      choice = choose_below(choice, level);
      Region& region = choice.region;
      const Buffer<uint32_t> edges = region.edges();
      EXPECT_FALSE(region.has_curves);
      const bool has_creases = round % 2 == 1;
      if (has_creases)
        for (int i = 0; i < 5; ++i) topology.kind[edges[random() % edges.size()]] = EdgeKind::crease;
      Buffer<Vec3f> normals = face_normals(level->mesh);
      for (int i = 0; i < 5; ++i) normals[random() % normals.size()] = {};
      const NormalProducts kept(topology.edge_count(), std::numeric_limits<float>::infinity());
      const auto find = [&](bool has_curves, Growth growth, const NormalProducts& products) {
        region.has_curves = has_curves;
        return find_curved(level->mesh, normals, products, 0.95, growth, region);
      };
      for (const Growth growth : {Growth::off, Growth::faces, Growth::vertices}) {
        EdgeMarks expected(topology.edge_count(), 0);
        for (uint32_t e : edges) {
          Region alone;
          alone.has_edge.assign(topology.edge_count(), 0);
          alone.has_edge[e] = 1;
          expected[e] = find_curved(level->mesh, normals, kept, 0.95, Growth::off, alone)[e];
          ++(expected[e] != 0 ? curved : flat);
        }
        grow(topology, growth, region, expected);
        EXPECT_EQ(find(true, growth, {}), expected);
        EXPECT_EQ(find(true, growth, kept), expected) << "from what is known";
        if (has_creases) continue;
        EXPECT_EQ(find(false, growth, {}), expected) << "by faces";
      }
    }
  EXPECT_GT(curved, 1000U);
  EXPECT_GT(flat, 1000U);
}

/// Where errors do not decide, what one level more adds lies behind what was there.
void expect_more_of_the_same(const Mesh& coarse, Options options) {
  Buffer<Vec3f> above;
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
