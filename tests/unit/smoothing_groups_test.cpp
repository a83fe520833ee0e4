#include "core/mesh/smoothing_groups.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "papilio/refine.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

/// Returns the mesh with a group per face and a separate point per corner.
TriangleMesh with_groups(const TriangleMesh& mesh, const std::vector<double>& groups) {
  TriangleMesh out;
  Attribute attribute;
  attribute.is_smoothing_group = true;
  for (size_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto first = static_cast<uint32_t>(out.positions.size());
    out.triangles.push_back({first, first + 1, first + 2});
    for (const uint32_t p : mesh.triangles[f]) {
      out.positions.push_back(mesh.positions[p]);
      attribute.values.push_back(groups[f]);
    }
  }
  out.attributes.push_back(attribute);
  return out;
}

/// Groups of an octahedron: 1 for faces above the plane z = 0, 2 for faces below.
std::vector<double> halves(const TriangleMesh& octahedron) {
  std::vector<double> groups;
  for (const Triangle& t : octahedron.triangles) {
    float z = 0;
    for (const uint32_t p : t) z += octahedron.positions[p].z;
    groups.push_back(z > 0 ? 1 : 2);
  }
  return groups;
}

uint32_t marked(const TriangleMesh& mesh, const Options& options = {}) {
  return shape_of(build_mesh(mesh), options).marked;
}

TEST(SmoothingGroups, EdgesBetweenGroupsAreMarked) {
  EXPECT_EQ(marked(with_groups(octahedron(), halves(octahedron()))), 4U);
  for (const Shape shape : {Shape::automatic, Shape::organic, Shape::mechanical, Shape::plain})
    EXPECT_EQ(marked(with_groups(octahedron(), halves(octahedron())), {.shape = shape}), 4U);
  EXPECT_EQ(marked(with_groups(octahedron(), halves(octahedron())), {.tension = Tension::off}), 4U);
}

TEST(SmoothingGroups, GroupZeroIsAGroupLikeOthers) {
  std::vector<double> groups(20, 3);
  groups[7] = 0;
  EXPECT_EQ(marked(with_groups(icosahedron(), groups)), 3U);
  groups.assign(20, 0);
  groups[7] = 3;
  EXPECT_EQ(marked(with_groups(icosahedron(), groups)), 3U);
}

TEST(SmoothingGroups, OneGroupForAllMarksNothing) {
  for (const double group : {0., 1., 7.})
    EXPECT_EQ(marked(with_groups(icosahedron(), std::vector<double>(20, group))), 0U);
}

TEST(SmoothingGroups, ComponentOfOneGroupMarksNothing) {
  const TriangleMesh two = join(octahedron(), octahedron(), 9);
  std::vector<double> groups = halves(octahedron());
  groups.resize(16, 0);  // the second octahedron has group 0
  EXPECT_EQ(marked(with_groups(two, groups)), 4U);
}

TEST(SmoothingGroups, OtherAttributesMarkNothing) {
  TriangleMesh mesh = with_groups(octahedron(), halves(octahedron()));
  mesh.attributes[0].is_smoothing_group = false;
  EXPECT_EQ(marked(mesh), 0U);
}

TEST(SmoothingGroups, CreaseAngleOverridesGroups) {
  const Mesh mesh = build_mesh(with_groups(octahedron(), halves(octahedron())));
  EXPECT_EQ(shape_of(mesh, {.crease_angle = 175}).creases, 0U);
  EXPECT_EQ(shape_of(mesh, {.crease_angle = 175}).marked, 0U);
  EXPECT_EQ(shape_of(mesh, {.crease_angle = 30}).creases, 12U);
}

TEST(SmoothingGroups, LevelsInheritTheMarksAndTheGroups) {
  for (const Scheme scheme : {Scheme::red_green, Scheme::in_place})
    for (const Shape shape : {Shape::organic, Shape::plain}) {
      const Mesh fine = refine(build_mesh(with_groups(octahedron(), halves(octahedron()))),
                               {.levels = 3, .scheme = scheme, .shape = shape, .edges = true})
                            .mesh;
      EXPECT_EQ(std::ranges::count(fine.topology.kind, EdgeKind::crease), 4 * 8);
      for (uint32_t h = 0; h < fine.topology.half_edge_count(); ++h) {
        const double group = fine.attributes.attributes[0].values[fine.attributes.point[h]];
        EXPECT_EQ(group, fine.attributes.attributes[0].values[fine.attributes.point[3 * Topology::face(h)]]);
        EXPECT_TRUE(group == 1 || group == 2);
      }
      // The output has equal marks when it is refined again.
      EXPECT_EQ(shape_of(fine).marked, 4U * 8);
    }
}

}  // namespace
}  // namespace papilio
