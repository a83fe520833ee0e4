#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "papilio/refine.h"
#include "proto/draco_reader.h"
#include "proto/draco_writer.h"
#include "proto/refinement.h"
#include "tests/support/shapes.h"

namespace papilio::test {
namespace {

Vec3d normal_at(const Mesh& mesh, size_t attribute, uint32_t h) {
  const double* v = &mesh.attributes.attributes[attribute].values[size_t{3} * mesh.attributes.point[h]];
  return {v[0], v[1], v[2]};
}

Vec3d normal_of_face(const Mesh& mesh, uint32_t f) {
  const auto at = [&](uint32_t i) { return to_double(mesh.positions[mesh.topology.origin[3 * f + i]]); };
  const Vec3d n = cross(at(1) - at(0), at(2) - at(0));
  return 1 / length(n) * n;
}

/// Returns the cosine of the largest angle between a corner's normal and its face's.
double least_agreement(const Mesh& mesh, size_t attribute = 0) {
  double least = 1;
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
    least = std::min(least, dot(normal_at(mesh, attribute, h), normal_of_face(mesh, h / 3)));
  return least;
}

/// A sphere whose points have the normals `of(position)`.
template <class Of>
Mesh sphere_with_normals(const Of& of) {
  TriangleMesh sphere = icosahedron();
  Attribute normals{.components = 3, .unit_length = true, .values = {}};
  for (Vec3f p : sphere.positions) {
    const Vec3d n = of(to_double(p));
    normals.values.insert(normals.values.end(), {n.x, n.y, n.z});
  }
  sphere.attributes = {normals};
  return build_mesh(sphere);
}

TEST(SurfaceNormals, SmoothMeshHasOneNormalPerVertex) {
  Mesh mesh = refine(build_mesh(torus(24, 16)), {.levels = 1}).mesh;
  add_normals(mesh);
  EXPECT_EQ(mesh.attributes.point_count, mesh.topology.vertex_count);
  EXPECT_GT(least_agreement(mesh), std::cos(0.2));
  const Buffer<Vec3f> smooth = vertex_normals(mesh);
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
    ASSERT_LT(length(normal_at(mesh, 0, h) - to_double(smooth[mesh.topology.origin[h]])), 1e-6);
}

TEST(SurfaceNormals, NormalsAreSplitAtCreases) {
  for (const Options& options : {Options{.levels = 2}, Options{.levels = 2, .flatness = {0.9}}}) {
    Mesh mesh = refine(build_mesh(box({2, 2, 2}, {1, 1, 1})), options).mesh;
    add_normals(mesh);
    EXPECT_GT(least_agreement(mesh), 1 - 1e-6);
    EXPECT_GT(mesh.attributes.point_count, mesh.topology.vertex_count);
  }
}

TEST(SurfaceNormals, SplitNormalsKeepOtherAttributes) {
  TriangleMesh shape = cube();
  Attribute numbers;
  for (size_t p = 0; p < shape.positions.size(); ++p) numbers.values.push_back(static_cast<double>(p));
  shape.attributes = {numbers};
  const Mesh before = refine(build_mesh(shape), {.levels = 2}).mesh;
  Mesh mesh = before;
  add_normals(mesh);
  ASSERT_EQ(mesh.attributes.attributes.size(), 2U);
  ASSERT_EQ(mesh.attributes.attributes[0].values.size(), mesh.attributes.point_count);
  EXPECT_GT(least_agreement(mesh, 1), 1 - 1e-6);
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
    ASSERT_EQ(mesh.attributes.attributes[0].values[mesh.attributes.point[h]],
              before.attributes.attributes[0].values[before.attributes.point[h]]);
}

TEST(SurfaceNormals, RenewedNormalsFollowTheSurface) {
  const Mesh coarse = sphere_with_normals([](Vec3d p) {
    const Vec3d wrong = p + Vec3d{0.4, 0.1, -0.3};  // inaccurate, as in edited files
    return 1 / length(wrong) * wrong;
  });
  Mesh fine = refine(coarse, {.levels = 3}).mesh;
  EXPECT_LT(least_agreement(fine), 0.95);
  renew_normals(fine, 0);
  EXPECT_GT(least_agreement(fine), std::cos(0.2));
  EXPECT_EQ(fine.attributes.point_count, fine.topology.vertex_count);
}

TEST(SurfaceNormals, RenewedNormalsKeepTheirSide) {
  Mesh fine = refine(sphere_with_normals([](Vec3d p) { return -1 / length(p) * p; }), {.levels = 2}).mesh;
  renew_normals(fine, 0);
  for (uint32_t h = 0; h < fine.topology.half_edge_count(); ++h)
    ASSERT_LT(dot(normal_at(fine, 0, h), normal_of_face(fine, h / 3)), -0.9);
}

/// Each triangle has separate points, whose normals differ by rounding.
TEST(SurfaceNormals, RenewedNormalsAreMergedIfInputsDifferByRounding) {
  const TriangleMesh shape = torus(12, 8);
  const Buffer<Vec3f> smooth = vertex_normals(build_mesh(shape));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> rounding(-1e-3, 1e-3);
  const Mesh mesh = build_mesh(shape);
  TriangleMesh apart;
  Attribute normals{.components = 3, .unit_length = true, .values = {}};
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
    const uint32_t v = mesh.topology.origin[h];
    if (h % 3 == 0) apart.triangles.push_back({h, h + 1, h + 2});
    apart.positions.push_back(mesh.positions[v]);
    for (const float x : {smooth[v].x, smooth[v].y, smooth[v].z}) normals.values.push_back(x + rounding(random));
  }
  apart.attributes = {normals};
  for (const Options& options : {Options{.levels = 2}, Options{.levels = 3, .tolerance = 0.002}}) {
    Mesh fine = refine(build_mesh(apart), options).mesh;
    renew_normals(fine, 0);
    std::vector<Vec3d> first(fine.topology.vertex_count);
    for (uint32_t h = 0; h < fine.topology.half_edge_count(); ++h) {
      Vec3d& seen = first[fine.topology.origin[h]];
      if (seen == Vec3d{}) seen = normal_at(fine, 0, h);
      EXPECT_EQ(seen, normal_at(fine, 0, h));
    }
  }
}

// Points that differ only in texture coordinates get one normal; points of different normals stay apart.
TEST(SurfaceNormals, RenewedNormalsAreSplitWhereTheInputsAre) {
  TriangleMesh shape = cube();
  TriangleMesh apart;
  Attribute flat{.components = 3, .unit_length = true, .values = {}};
  Attribute smooth = flat;
  Attribute chart;
  const Vec3d middle = bounding_box(shape.positions).centre();
  for (const Triangle& t : shape.triangles) {
    const auto first = static_cast<uint32_t>(apart.positions.size());
    apart.triangles.push_back({first, first + 1, first + 2});
    const auto at = [&](uint32_t i) { return to_double(shape.positions[t[i]]); };
    const Vec3d n = cross(at(1) - at(0), at(2) - at(0));
    for (uint32_t i = 0; i < 3; ++i) {
      apart.positions.push_back(shape.positions[t[i]]);
      const Vec3d face = 1 / length(n) * n;
      const Vec3d out = 1 / length(at(i) - middle) * (at(i) - middle);
      flat.values.insert(flat.values.end(), {face.x, face.y, face.z});
      smooth.values.insert(smooth.values.end(), {out.x, out.y, out.z});
      chart.values.push_back(first);
    }
  }
  const auto renewed = [&](const Attribute& normals) {
    TriangleMesh mesh = apart;
    mesh.attributes = {normals, chart};
    Mesh fine = refine(build_mesh(mesh), {.levels = 2, .shape = Shape::organic}).mesh;
    renew_normals(fine, 0);
    return fine;
  };
  const Mesh of_flat = renewed(flat);
  const Mesh of_smooth = renewed(smooth);
  const auto count_at_first_vertex = [](const Mesh& mesh) {
    std::set<std::tuple<double, double, double>> found;
    for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
      if (mesh.topology.origin[h] == 0) {
        const Vec3d n = normal_at(mesh, 0, h);
        found.emplace(n.x, n.y, n.z);
      }
    return found.size();
  };
  EXPECT_EQ(count_at_first_vertex(of_flat), 3U);
  EXPECT_EQ(count_at_first_vertex(of_smooth), 1U);
}

TEST(SurfaceNormals, AnswerHasNormalsIfRequestedOrGiven) {
  using namespace proto;
  const auto asking = [](int levels, bool normals) {
    Parameters parameters;
    parameters.options.levels = levels;
    parameters.normals = normals;
    return parameters;
  };
  const std::string plain = write_draco_exact(cube());
  const FormattedMesh added = read_draco(Refinement(plain, asking(2, true), {}).run().bytes, {});
  ASSERT_EQ(added.format.attributes.size(), 1U);
  EXPECT_EQ(added.format.attributes[0].kind, AttributeKind::normal);
  EXPECT_GT(least_agreement(build_mesh(added)), 0.999);
  EXPECT_TRUE(read_draco(Refinement(plain, asking(2, false), {}).run().bytes, {}).attributes.empty());

  const Mesh coarse = sphere_with_normals([](Vec3d p) {
    const Vec3d wrong = p + Vec3d{0.4, 0.1, -0.3};
    return 1 / length(wrong) * wrong;
  });
  const MeshFormat format{.attributes = {{.kind = AttributeKind::normal, .id = 7}}};
  const std::string own = write_draco_exact(coarse.triangles(), format);
  for (bool asked : {false, true}) {
    const FormattedMesh fine = read_draco(Refinement(own, asking(3, asked), {}).run().bytes, {});
    EXPECT_EQ(fine.format, format);
    EXPECT_GT(least_agreement(build_mesh(fine)), std::cos(0.25));
    const FormattedMesh same = read_draco(Refinement(own, asking(0, asked), {}).run().bytes, {});
    EXPECT_LT(least_agreement(build_mesh(same)), 0.85) << "level 0 keeps the given normals";
  }
}

}  // namespace
}  // namespace papilio::test
