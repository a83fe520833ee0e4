#include "core/hierarchy/transition.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "core/criteria/selection.h"
#include "tests/support/shapes.h"

// Transition faces are judged four at a time in floats: what is decided must be the same as of each by itself in
// double.

namespace papilio {
namespace {

using namespace test;

/// A level whose new vertices are `made` [E].
std::shared_ptr<HierarchyLevel> level_of(const Mesh& mesh, const Buffer<Vec3f>& made) {
  auto level = std::make_shared<HierarchyLevel>(coarsest_level(mesh));
  level->trial.made = made;
  return level;
}

LevelChoice choice_of(std::shared_ptr<HierarchyLevel> level, const std::vector<uint32_t>& edges) {
  LevelChoice choice = choose_coarsest(std::move(level));
  for (uint32_t e : edges) choice.split_edge(e);
  return choice;
}

/// What avoid_slivers() does, where nothing is noted of faces: each is judged by itself.
void avoid_slivers_one_by_one(LevelChoice& choice, double most_cosine) {
  const Topology& mesh = choice.level->mesh.topology;
  std::vector<uint32_t> faces;
  const auto add = [&](uint32_t f) {
    const unsigned mask = choice.split_mask(f);
    if (mask != 0 && mask != 7 && choice.may_divide(f) &&
        (Transition::find(choice, f, mask, most_cosine) & Transition::has_sliver) != 0)
      faces.push_back(f);
  };
  for (uint32_t f = 0; f < mesh.face_count(); ++f) add(f);
  while (!faces.empty()) {
    const uint32_t f = faces.back();
    faces.pop_back();
    for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) choice.split_edge(mesh.edge[h]);
    for (uint32_t h = 3 * f; h < 3 * f + 3; ++h)
      if (mesh.twin[h] != none) add(Topology::face(mesh.twin[h]));
  }
}

struct PartSplit {
  size_t faces = 0, second_diagonals = 0, divided = 0;
};

/// Splits random edges, and compares what becomes of the faces in part split.
void compare(const Mesh& mesh, const Buffer<Vec3f>& made, double most_cosine, std::mt19937& random, PartSplit& count) {
  std::vector<uint32_t> edges;
  for (uint32_t e = 0; e < mesh.topology.edge_count(); ++e)
    if (random() % 2 == 0) edges.push_back(e);
  const auto level = level_of(mesh, made);
  LevelChoice choice = choice_of(level, edges);
  const auto faces = choice.faces_split_in_part();
  avoid_slivers(choice, most_cosine);

  LevelChoice expected = choice_of(level, edges);
  avoid_slivers_one_by_one(expected, most_cosine);
  ASSERT_EQ(choice.split_edges, expected.split_edges);
  for (const auto& [face, mask] : faces) {
    const uint8_t one_by_one = choose_transition(expected, face, mask, most_cosine);
    ASSERT_EQ(choose_transition(choice, face, mask, most_cosine), one_by_one);
    count.second_diagonals += one_by_one % 2;
  }
  count.faces += faces.size();
  count.divided += choice.split_edges.size() - edges.size();
}

Buffer<Vec3f> middles(const Mesh& mesh) {
  Buffer<Vec3f> made(mesh.topology.edge_count());
  for (uint32_t e = 0; e < made.size(); ++e) made[e] = to_float(midpoint(mesh, e));
  return made;
}

TEST(Transitions, AreTheSameJudgedFourAtATime) {
  std::mt19937 random(11);
  PartSplit count;
  for (int i = 0; i < 400; ++i) {
    // Of any size, wherever; at times stretched until faces are needles.
    const float size = std::pow(10.0F, std::uniform_real_distribution<float>(-14, 14)(random));
    const float far = random() % 3 == 0 ? 100 * size : 0;
    const float stretch = random() % 3 == 0 ? 1e-3F : 1;
    TriangleMesh triangles = random_manifold(random);
    for (Vec3f& p : triangles.positions) p = {size * p.x + far, size * stretch * p.y, size * stretch * p.z};
    const Mesh mesh = build_mesh(triangles);
    std::normal_distribution<float> shift(0, 0.1F * size);
    Buffer<Vec3f> made = middles(mesh);
    for (Vec3f& p : made) p += Vec3f{shift(random), stretch * shift(random), stretch * shift(random)};
    const double smallest = std::uniform_real_distribution<double>(0.001, 0.6)(random);
    compare(mesh, made, most_cosine_beside(smallest), random, count);
  }
  EXPECT_GT(count.faces, 5000U);
  EXPECT_GT(count.second_diagonals, count.faces / 8);
  EXPECT_GT(count.divided, 500U);
}

TEST(Transitions, AreTheSameWhereDiagonalsAreEqualAndAnglesJustTheSmallest) {
  std::mt19937 random(12);
  PartSplit count;
  for (int i = 0; i < 40; ++i)
    for (const TriangleMesh& triangles : {grid(9, 7), torus(12, 9), icosahedron(), box({3, 3, 3}, {1, 1, 1})}) {
      const Mesh mesh = build_mesh(triangles);
      // A half square's pieces have angles of 45 degrees and of atan(1/2), and the like.
      for (const double angle : {std::numbers::pi / 4, std::atan(0.5), std::atan(1.0 / 3), std::numbers::pi / 6})
        compare(mesh, middles(mesh), std::cos(angle), random, count);
    }
  EXPECT_GT(count.faces, 10000U);
  EXPECT_GT(count.divided, 500U);
}

/// In degrees, by the law of cosines.
double smallest_angle_of(const Mesh& mesh, uint32_t face) {
  const auto corner = [&](uint32_t i) { return to_double(mesh.positions[mesh.topology.origin[3 * face + i % 3]]); };
  double smallest = 180;
  for (uint32_t i = 0; i < 3; ++i) {
    const Vec3d one = corner(i + 1) - corner(i);
    const Vec3d other = corner(i + 2) - corner(i);
    smallest = std::min(smallest, std::atan2(length(cross(one, other)), dot(one, other)) * 180 / std::numbers::pi);
  }
  return smallest;
}

TEST(SmallestAngle, IsThatOfAllFacesWhateverTheirSize) {
  std::mt19937 random(13);
  for (int i = 0; i < 400; ++i) {
    const float size = std::pow(10.0F, std::uniform_real_distribution<float>(-14, 14)(random));
    TriangleMesh triangles = random_manifold(random);
    for (Vec3f& p : triangles.positions) p = {size * p.x, size * p.y, size * (i % 2 == 0 ? 0.1F : 1) * p.z};
    const Mesh mesh = build_mesh(triangles);
    double smallest = 180;
    for (uint32_t f = 0; f < mesh.topology.face_count(); ++f) smallest = std::min(smallest, smallest_angle_of(mesh, f));
    EXPECT_NEAR(smallest_angle(mesh) * 180 / std::numbers::pi, smallest, 1e-5);
  }
}

TEST(SmallestAngle, IsThatOfTheFacesOneByOneToTheBit) {
  std::mt19937 random(14);
  for (int i = 0; i < 200; ++i) {
    TriangleMesh triangles = i % 2 == 0 ? random_manifold(random) : torus(5 + random() % 9, 4 + random() % 5);
    const float flat = std::pow(10.0F, std::uniform_real_distribution<float>(-6, 0)(random));
    for (Vec3f& p : triangles.positions) p = {flat * p.x, p.y, p.z};
    const Mesh mesh = build_mesh(triangles);
    double smallest = std::numbers::pi;
    for (uint32_t f = 0; f < mesh.topology.face_count(); ++f) {
      const auto corner = [&](uint32_t c) { return mesh.positions[mesh.topology.origin[3 * f + c]]; };
      smallest = std::min(smallest, smallest_angle(build_mesh({{corner(0), corner(1), corner(2)}, {{0, 1, 2}}})));
    }
    EXPECT_EQ(smallest_angle(mesh), smallest);
  }
}

}  // namespace
}  // namespace papilio
