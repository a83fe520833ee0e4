#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>

#include "core/criteria/deviation.h"
#include "core/criteria/selection.h"
#include "core/hierarchy/hierarchy.h"
#include "core/mesh/crease.h"
#include "core/mesh/normals.h"
#include "core/rules/butterfly.h"
#include "core/rules/family_butterfly.h"
#include "core/rules/features.h"
#include "core/rules/tension.h"
#include "core/schemes/uniform_error.h"
#include "core/split/split.h"
#include "core/split/split_in_four.h"
#include "papilio/refine.h"
#include "tests/support/shapes.h"
#include "tests/support/whole_split.h"

// Uniform levels are computed per face. They are bit-identical to levels computed per edge.

namespace papilio {
namespace {

using namespace test;

/// Three sheets that share a line, and two that touch at a point.
TriangleMesh shared_and_pinched() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5F}, {-1, 1, 0.5F}, {-1, -1, 0.5F},
                    {3, 0, 0}, {3, 1, 0}, {4, 0, 1},    {2, 0, 1},     {2, 1, 2}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {5, 6, 7}, {5, 8, 9}, {2, 1, 7}};
  return mesh;
}

/// Many shapes with jittered vertices, so that confused weights change results.
std::vector<Mesh> shaken_meshes() {
  std::vector<TriangleMesh> shapes{tetrahedron(),
                                   icosahedron(),
                                   cube(),
                                   torus(7, 5),
                                   grid(4, 3),
                                   square_ring(4, 1, 2, 0.5F),
                                   fan(40, true),
                                   fan(5, false),
                                   bipyramid(50),
                                   shared_and_pinched(),
                                   bipyramid(3),
                                   join(cube(), grid(2, 2), 5),
                                   box({3, 2, 1}, {3, 2, 1})};
  std::mt19937 random(7);
  for (int i = 0; i < 40; ++i) shapes.push_back(random_manifold(random));
  std::uniform_real_distribution<float> shake(-0.1F, 0.1F);
  std::vector<Mesh> meshes;
  for (TriangleMesh& shape : shapes) {
    for (Vec3f& p : shape.positions) p += Vec3f{shake(random), shake(random), shake(random)};
    meshes.push_back(build_mesh(shape));
    Mesh creased = meshes.back();
    mark_creases(creased, 40);
    meshes.push_back(creased);
  }
  return meshes;
}

void expect_same(const Topology& one, const Topology& other) {
  EXPECT_EQ(one.vertex_count, other.vertex_count);
  EXPECT_EQ(one.origin, other.origin);
  EXPECT_EQ(one.twin, other.twin);
  EXPECT_EQ(one.edge, other.edge);
  EXPECT_EQ(one.kind, other.kind);
  EXPECT_EQ(one.pinched, other.pinched);
  EXPECT_EQ(one.darts, other.darts);
  for (uint32_t e = 0; e < one.edge_count(); ++e) ASSERT_EQ(one.edge[one.half_edge[e]], e);
}

TEST(SplitInFour, ResultEqualsSplittingEveryEdge) {
  for (Mesh& mesh : shaken_meshes())
    for (int level = 0; level < 3; ++level) {
      Buffer<Vec3f> positions = mesh.positions;
      positions.resize(positions.size() + mesh.topology.edge_count(), Vec3f{});
      const Topology expected = split(mesh.topology, Marks(mesh.topology.edge_count(), 1), positions, mesh.attributes);
      const Topology made = split_in_four(mesh.topology);
      expect_same(made, expected);
      const Topology last = split_last_in_four(mesh.topology);
      EXPECT_FALSE(last.has_edges());
      EXPECT_EQ(last.origin, expected.origin);
      EXPECT_EQ(last.twin, expected.twin);
      const Topology two_levels_on = split_last_in_sixteen(mesh.topology);
      const Topology one_by_one = split_last_in_four(made);
      EXPECT_EQ(two_levels_on.vertex_count, one_by_one.vertex_count);
      EXPECT_EQ(two_levels_on.origin, one_by_one.origin);
      EXPECT_EQ(two_levels_on.twin, one_by_one.twin);
      EXPECT_EQ(two_levels_on.pinched, one_by_one.pinched);
      EXPECT_EQ(two_levels_on.darts, one_by_one.darts);
      mesh.topology = made;
      mesh.positions = positions;
    }
}

TEST(SplitInFour, HalvesOfAnEdgeStartAtItsEndAndMiddle) {
  const Mesh mesh = build_mesh(torus(5, 4));
  const Topology finer = split_in_four(mesh.topology);
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
    const uint32_t middle = mesh.topology.vertex_count + mesh.topology.edge[h];
    EXPECT_EQ(finer.origin[first_half(h)], mesh.topology.origin[h]);
    EXPECT_EQ(finer.tip(first_half(h)), middle);
    EXPECT_EQ(finer.origin[second_half(h)], middle);
    EXPECT_EQ(finer.tip(second_half(h)), mesh.topology.tip(h));
  }
}

TEST(Features, DescendedFeaturesEqualSearchedOnes) {
  for (Mesh& mesh : shaken_meshes()) {
    Features features = find_features(mesh.topology);
    for (int level = 1; level <= 3; ++level) {
      descend(features, mesh.topology.vertex_count);
      mesh.topology = split_in_four(mesh.topology);
      Features found = find_features(mesh.topology);
      EXPECT_EQ(features.level, level);
      EXPECT_EQ(features.spokes, found.spokes);
      EXPECT_EQ(features.first_spoke, found.first_spoke);
      EXPECT_EQ(features.is_closed, found.is_closed);
      EXPECT_EQ(features.centre, found.centre);
      std::ranges::sort(features.curve_half_edges);
      EXPECT_EQ(features.curve_half_edges, found.curve_half_edges);
    }
  }
}

/// A level of a mesh with the connectivity of the level above.
struct WholeLevel {
  Topology parents;
  Mesh mesh;
  Features features{};
};

/// Computes the next level of a mesh or a level by the plain scheme.
WholeLevel next_level(const Mesh& mesh, Features features) {
  WholeLevel below{.parents = mesh.topology, .mesh = {split_in_four(mesh.topology), mesh.positions}};
  below.mesh.positions.resize(below.mesh.topology.vertex_count);
  butterfly(mesh.topology, features, mesh.positions.data(), &below.mesh.positions[mesh.topology.vertex_count]);
  descend(features, mesh.topology.vertex_count);
  below.features = std::move(features);
  return below;
}

TEST(Butterfly, VerticesFromTheLevelAboveAreBitIdentical) {
  int compared = 0;
  for (const Mesh& mesh : shaken_meshes()) {
    Features features = find_features(mesh.topology);
    if (!features.are_rings()) continue;
    WholeLevel level = next_level(mesh, features);
    for (int k = 0; k < 2; ++k) {
      const Vec3f* positions = level.mesh.positions.data();
      Buffer<Vec3f> expected(level.mesh.topology.edge_count());
      butterfly(level.mesh.topology, level.features, positions, expected.data());
      Buffer<Vec3f> made(expected.size());
      butterfly_below(level.parents, nullptr, features, positions, made.data());
      EXPECT_EQ(made, expected);
      ++compared;
      features = level.features;
      level = next_level(level.mesh, level.features);
    }
  }
  EXPECT_GT(compared, 20);
}

TEST(UniformError, ErrorIsTheLargestDeviation) {
  for (const Mesh& mesh : shaken_meshes()) {
    const WholeLevel level = next_level(mesh, find_features(mesh.topology));
    Buffer<Vec3f> made(level.mesh.topology.edge_count());
    butterfly(level.mesh.topology, level.features, level.mesh.positions.data(), made.data());
    double largest = 0;
    for (uint32_t e = 0; e < level.mesh.topology.edge_count(); ++e)
      largest = std::max(largest, deviation(level.mesh, e, made[e]));
    EXPECT_GT(largest, 0);
    EXPECT_EQ(largest_deviation(level.mesh, made.data(), 1), largest);
    if (level.features.curve_half_edges.empty()) {
      EXPECT_EQ(largest_deviation_below(level.parents, level.mesh.positions, made.data(), 1), largest);
    }
  }
}

void expect_same_result(const Result& one, const Result& other) {
  EXPECT_EQ(one.mesh.positions, other.mesh.positions);
  EXPECT_EQ(one.mesh.topology.vertex_count, other.mesh.topology.vertex_count);
  EXPECT_EQ(one.mesh.topology.origin, other.mesh.topology.origin);
  EXPECT_EQ(one.mesh.topology.twin, other.mesh.topology.twin);
  EXPECT_EQ(one.error, other.error);
}

// An intermediate level is skipped without edges and hooks.
TEST(Uniform, SkippedLevelDoesNotChangeTheResult) {
  std::vector<Mesh> meshes = shaken_meshes();
  meshes.push_back(build_mesh(torus(120, 100)));  // enough for two threads
  for (const Mesh& mesh : meshes)
    for (int levels = 1; levels <= (mesh.topology.face_count() > 10000 ? 2 : 4); ++levels) {
      Options options{.levels = levels, .tension = Tension::off};
      const Result with_edges = refine(Mesh(mesh), options);
      EXPECT_GT(with_edges.error, 0);
      options.edges = false;
      expect_same_result(refine(Mesh(mesh), options), with_edges);
      expect_same_result(refine(Mesh(mesh), options, {.threads = 2}), with_edges);
      int seen = 0;
      const Hooks hooks{.on_level = [&](const Level& level) { seen += level.mesh.topology.face_count() > 0 ? 1 : 0; }};
      expect_same_result(refine(Mesh(mesh), options, hooks), with_edges);
      EXPECT_EQ(seen, levels + 1);
    }
}

TEST(MeasureError, ResultDoesNotDependOnTheOption) {
  const Mesh mesh = build_mesh(torus(9, 7));
  const View view{.eye = {4, 1, 1}, .error_pixels = 2};
  for (const Options& measured :
       {Options{.levels = 2}, Options{.levels = 3, .tension = Tension::off, .edges = false},
        Options{.levels = 2, .flatness = {0.9}}, Options{.levels = 2, .tolerance = 1e-3},
        Options{.levels = 2, .scheme = Scheme::in_place, .flatness = {0.9}}, Options{.levels = 2, .view = view}}) {
    Options options = measured;
    options.measure_error = false;
    Result expected = refine(Mesh(mesh), measured);
    const Result made = refine(Mesh(mesh), options);
    EXPECT_GT(expected.error, 0);
    EXPECT_EQ(expected.error_pixels > 0, measured.view.has_value());
    expected.error = 0;
    expect_same_result(made, expected);
    EXPECT_EQ(made.error_pixels, 0);
  }
}

}  // namespace
}  // namespace papilio
