#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"
#include "tests/support/simplified.h"

// Simplification of meshes with attributes that are split at seams.

namespace papilio {
namespace {

using namespace test;

/// Returns a mesh with a chart per value of `chart_of(centroid)`; attributes are the position and the chart.
template <class ChartOf>
Mesh charted(const TriangleMesh& shape, const ChartOf& chart_of) {
  Mesh mesh = build_mesh(shape);
  Attribute position{3, false, {}};
  Attribute chart{1, false, {}};
  std::map<std::pair<uint32_t, int>, uint32_t> points;
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
    const auto corner = [&](uint32_t i) { return mesh.positions[mesh.topology.origin[h - h % 3 + i]]; };
    const int c = chart_of((1.0F / 3) * (corner(0) + corner(1) + corner(2)));
    const auto number = static_cast<uint32_t>(points.size());
    const auto [at, is_new] = points.try_emplace({mesh.topology.origin[h], c}, number);
    if (is_new) {
      const Vec3f p = mesh.positions[mesh.topology.origin[h]];
      position.values.insert(position.values.end(), {p.x, p.y, p.z});
      chart.values.push_back(c);
    }
    mesh.attributes.point.push_back(at->second);
  }
  mesh.attributes.point_count = static_cast<uint32_t>(points.size());
  mesh.attributes.attributes = {position, chart};
  return mesh;
}

void expect_charts_whole(const Mesh& mesh) {
  const PointAttributes& attributes = mesh.attributes;
  ASSERT_EQ(attributes.point.size(), mesh.topology.half_edge_count());
  ASSERT_EQ(attributes.attributes.size(), 2U);
  ASSERT_EQ(attributes.attributes[0].values.size(), size_t{3} * attributes.point_count);
  ASSERT_EQ(attributes.attributes[1].values.size(), attributes.point_count);
  const std::set<uint32_t> used(attributes.point.begin(), attributes.point.end());
  EXPECT_EQ(used.size(), attributes.point_count);
  EXPECT_LT(*used.rbegin(), attributes.point_count);
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
    const uint32_t p = attributes.point[h];
    const double* values = &attributes.attributes[0].values[size_t{3} * p];
    ASSERT_EQ(to_double(mesh.positions[mesh.topology.origin[h]]), (Vec3d{values[0], values[1], values[2]}));
    ASSERT_EQ(attributes.attributes[1].values[p],
              attributes.attributes[1].values[attributes.point[Topology::next(h)]]);  // a face is in one chart
  }
}

/// Returns the edges between two charts by the positions of their ends.
std::set<std::array<Place, 2>> seams(const Mesh& mesh) {
  std::set<std::array<Place, 2>> found;
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
    const uint32_t t = mesh.topology.twin[h];
    if (t != none && mesh.attributes.point[h] != mesh.attributes.point[Topology::next(t)])
      found.insert({place(mesh.positions[mesh.topology.origin[h]]), place(mesh.positions[mesh.topology.tip(h)])});
  }
  return found;
}

TEST(SimplifyCharts, AttributesAreKept) {
  const auto halves = [](Vec3f p) { return p.x < 0.1F ? 1 : 2; };
  const auto patches = [](Vec3f p) {
    return static_cast<int>(10 + std::floor(4 * p.x) + 20 * std::floor(4 * p.y) + 400 * std::floor(4 * p.z));
  };
  for (const Mesh& mesh : {charted(torus(80, 40), halves), charted(torus(80, 40), patches),
                           charted(real_mesh("cgal/lion-head.off"), patches)}) {
    expect_charts_whole(mesh);
    std::vector<View> views = views_of(mesh);
    views.push_back(looking_elsewhere(mesh));
    for (const View& view : views) {
      const Mesh result = simplify_checked(mesh, view);
      expect_charts_whole(result);
      EXPECT_EQ(seams(result), seams(mesh));
      EXPECT_LT(share_left(mesh, view, result), 0.8);
    }
  }
}

// At the end of the seam, an edge has two points at one of its vertices.
TEST(SimplifyCharts, SeamThatEndsInsideIsKept) {
  Mesh mesh = charted(grid(20, 20), [](Vec3f) { return 0; });
  const Topology& topology = mesh.topology;
  for (uint32_t h = 0; h < topology.half_edge_count(); ++h) {
    const Vec3f p = mesh.positions[topology.origin[h]];
    const Vec3f middle = 0.5F * (mesh.positions[topology.tip(h)] + mesh.positions[topology.apex(h)]);
    if (p.x != 10 || p.y < 5 || p.y > 15 || middle.x < 10) continue;  // the right side of a slit
    mesh.attributes.point[h] = mesh.attributes.point_count + static_cast<uint32_t>(p.y) - 5;
  }
  for (int y = 5; y <= 15; ++y) {
    mesh.attributes.attributes[0].values.insert(mesh.attributes.attributes[0].values.end(), {10, double(y), 0});
    mesh.attributes.attributes[1].values.push_back(0);
  }
  mesh.attributes.point_count += 11;
  expect_charts_whole(mesh);
  const Mesh result = simplify_checked(mesh, looking_elsewhere(mesh));
  expect_charts_whole(result);
  EXPECT_EQ(seams(result), seams(mesh));
  EXPECT_LT(share_left(mesh, looking_elsewhere(mesh), result), 0.5);
}

}  // namespace
}  // namespace papilio
