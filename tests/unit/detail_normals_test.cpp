#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/detail/own_normals.h"
#include "papilio/detail.h"
#include "tests/support/lens.h"
#include "tests/support/shapes.h"

// Normals of an original: splits, and normals of the decoded levels.

namespace papilio {
namespace {

using test::Shading;

constexpr double rim_angle = 30;  // degrees, less than that of edges that are sharp by themselves
constexpr uint32_t lens_segments = 32, lens_rings = 10;
/// Angle between the facets at the rim of the decoded surface; their normals are half a ring inside.
constexpr double facet_angle = rim_angle + (180 - rim_angle) / 2 / lens_rings;

TriangleMesh lens(Shading shading) { return test::lens(lens_segments, lens_rings, rim_angle, shading); }

size_t number_of_creases(const Topology& t) {
  return static_cast<size_t>(std::ranges::count(t.kind, EdgeKind::crease));
}

double degrees_between(Vec3d a, Vec3d b) { return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi; }

Vec3d normal_at(const Mesh& mesh, uint32_t h) {
  const double* value = &mesh.attributes.attributes.back().values[size_t{3} * mesh.attributes.point[h]];
  return {value[0], value[1], value[2]};
}

/// Returns the mean angle between the normals of both faces at the ends of edges, of creases or of other edges.
double mean_split(const Mesh& mesh, bool at_creases) {
  double sum = 0;
  size_t count = 0;
  const Topology& t = mesh.topology;
  for (uint32_t h = 0; h < t.half_edge_count(); ++h) {
    if (t.is_curve(h) != at_creases) continue;
    sum += degrees_between(normal_at(mesh, h), normal_at(mesh, Topology::next(t.twin[h])));
    ++count;
  }
  return sum / static_cast<double>(count);
}

/// Returns the mean angle of the corners' normals to those of the caps.
double mean_angle_to_caps(const Mesh& mesh) {
  double sum = 0;
  const Topology& t = mesh.topology;
  for (uint32_t f = 0; f < t.face_count(); ++f) {
    float height = 0;
    for (uint32_t i = 0; i < 3; ++i) height += mesh.positions[t.origin[3 * f + i]].z;
    for (uint32_t h = 3 * f; h < 3 * f + 3; ++h)
      sum += degrees_between(normal_at(mesh, h), test::lens_normal(mesh.positions[t.origin[h]], rim_angle, height > 0));
  }
  return sum / t.half_edge_count();
}

/// Encodes an original and decodes it with normals of its style.
Mesh encode_and_decode(const TriangleMesh& original, NormalStyle expected) {
  const EncodedDetail encoded =
      encode_detail(original, {.rms = 1e-3, .face_limit = 8000}, [](const TriangleMesh& base, std::span<const Vec3d>) {
        return CodedBase{base, 9 * base.positions.size()};
      });
  EXPECT_EQ(encoded.normals, expected);
  EXPECT_TRUE(encoded.base.triangles.attributes.empty());
  Mesh decoded = decode_detail(encoded.base, encoded.levels);
  add_detail_normals(decoded, encoded.normals);
  return decoded;
}

TEST(OwnNormals, LensIsHardAtItsRim) {
  const Mesh mesh = build_mesh(lens(Shading::hard_rim));
  const OwnNormals found = find_own_normals(mesh);
  EXPECT_EQ(found.style, NormalStyle::creased);
  for (uint32_t e = 0; e < mesh.topology.edge_count(); ++e) {
    const uint32_t h = mesh.topology.half_edge[e];
    const bool is_rim = mesh.positions[mesh.topology.origin[h]].z == 0 && mesh.positions[mesh.topology.tip(h)].z == 0;
    EXPECT_EQ(found.is_hard[e], is_rim);
  }
}

TEST(OwnNormals, SmoothFacetedAndAbsentStylesAreRecognized) {
  EXPECT_EQ(find_own_normals(build_mesh(lens(Shading::smooth))).style, NormalStyle::smooth);
  EXPECT_EQ(find_own_normals(build_mesh(lens(Shading::faceted))).style, NormalStyle::faceted);
  EXPECT_EQ(find_own_normals(build_mesh(lens(Shading::absent))).style, NormalStyle::absent);
}

TEST(OwnNormals, OnlyHardEdgesBecomeCreases) {
  for (const Shading shading : {Shading::absent, Shading::smooth, Shading::hard_rim, Shading::faceted}) {
    Mesh mesh = build_mesh(lens(shading));
    const Topology before = mesh.topology;
    (void)mark_detail_curves(mesh);
    EXPECT_EQ(number_of_creases(mesh.topology), shading == Shading::hard_rim ? lens_segments : 0);
    EXPECT_TRUE(mesh.attributes.empty());
    EXPECT_TRUE(std::ranges::equal(mesh.topology.origin, before.origin));
    EXPECT_TRUE(std::ranges::equal(mesh.topology.half_edge, before.half_edge));
  }
}

TEST(OwnNormals, SharpEdgesStayCreasesWhereFewAreHard) {
  // A box with hard edges only at its upper side: other edges are creases by their angle unless most edges are hard.
  TriangleMesh box = test::box({6, 6, 6}, {1, 1, 1});
  TriangleMesh points;
  Attribute normals{.components = 3, .unit_length = true, .values = {}};
  const auto top = [&](const Triangle& t) {
    return std::ranges::all_of(t, [&](uint32_t v) { return box.positions[v].z == 1; });
  };
  for (Triangle& triangle : box.triangles) {
    const bool is_top = top(triangle);
    for (uint32_t& corner : triangle) {
      const Vec3f p = box.positions[corner];
      points.positions.push_back(p);
      const Vec3d outward = is_top ? Vec3d{0, 0, 1} : to_double(p) - Vec3d{0.5, 0.5, 2};
      normals.values.insert(normals.values.end(), {outward.x, outward.y, outward.z});
      corner = static_cast<uint32_t>(points.positions.size() - 1);
    }
  }
  points.triangles = box.triangles;
  points.attributes.push_back(normals);
  Mesh few = build_mesh(points);
  EXPECT_EQ(mark_detail_curves(few), NormalStyle::creased);
  EXPECT_EQ(number_of_creases(few.topology), 12U * 6) << "4 of 12 edges are hard";
}

TEST(DetailNormals, NormalsAreSplitAsInTheOriginal) {
  const Mesh decoded = encode_and_decode(lens(Shading::hard_rim), NormalStyle::creased);
  EXPECT_GE(number_of_creases(decoded.topology), 16U);
  EXPECT_NEAR(mean_split(decoded, true), facet_angle, 5);
  EXPECT_EQ(mean_split(decoded, false), 0);
  EXPECT_LT(mean_angle_to_caps(decoded), 5);
}

TEST(DetailNormals, SmoothOriginalsHaveUnsplitNormals) {
  const Mesh decoded = encode_and_decode(lens(Shading::smooth), NormalStyle::smooth);
  EXPECT_EQ(number_of_creases(decoded.topology), 0U);
  EXPECT_EQ(mean_split(decoded, false), 0);
}

}  // namespace
}  // namespace papilio
