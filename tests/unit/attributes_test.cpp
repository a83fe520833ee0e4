#include "core/mesh/attributes.h"

#include <cmath>
#include <map>
#include <tuple>

#include "papilio/refine.h"
#include "tests/support/charts.h"
#include "tests/support/invariants.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

/// Uniform options and adaptive options of each criterion, in both schemes.
std::vector<Options> ways() {
  std::vector<Options> all;
  for (Scheme scheme : {Scheme::red_green, Scheme::in_place}) {
    all.push_back({.levels = 2, .scheme = scheme});
    all.push_back({.levels = 3, .scheme = scheme, .flatness = {0.5, 0.8, 0.95}, .growth = Growth::off});
    all.push_back({.levels = 3, .scheme = scheme, .tolerance = 0.01});
    all.push_back({.levels = 3, .scheme = scheme, .max_faces = 1000});
  }
  return all;
}

Mesh without_attributes(Mesh mesh) {
  mesh.attributes = {};
  return mesh;
}

uint32_t count_seams(const Mesh& mesh) {
  uint32_t seams = 0;
  const Buffer<uint32_t>& point = mesh.attributes.point;
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
    const uint32_t t = mesh.topology.twin[h];
    if (t == none || t < h) continue;
    seams += point[h] != point[Topology::next(t)] || point[t] != point[Topology::next(h)] ? 1 : 0;
  }
  return seams;
}

/// Expects the mesh refined without attributes; points at their vertices, all used; and tiled charts.
void expect_sound(const Mesh& refined, const Mesh& plain, double area) {
  ASSERT_TRUE(is_consistent(without_attributes(refined)));
  ASSERT_EQ(without_attributes(refined).triangles(), plain.triangles());
  ASSERT_EQ(refined.attributes.point.size(), refined.topology.half_edge_count());
  std::vector<uint32_t> vertex(refined.attributes.point_count, none);
  for (uint32_t h = 0; h < refined.topology.half_edge_count(); ++h) {
    uint32_t& v = vertex.at(refined.attributes.point[h]);
    ASSERT_TRUE(v == none || v == refined.topology.origin[h]);
    v = refined.topology.origin[h];
  }
  ASSERT_EQ(std::count(vertex.begin(), vertex.end(), none), 0);
  ASSERT_TRUE(tiles_its_charts(refined.triangles(), area));
}

TEST(Attributes, ChartsOfACubeStayTiledAndClosed) {
  const Mesh coarse = build_mesh(charted_cube());
  EXPECT_EQ(coarse.topology.vertex_count, 8U);
  EXPECT_EQ(coarse.attributes.point_count, 24U);
  for (Options options : ways()) {
    options.shape = Shape::plain;  // otherwise a cube converges at once
    const Mesh refined = refine(coarse, options).mesh;
    expect_sound(refined, refine(without_attributes(coarse), options).mesh, 1);
    EXPECT_EQ(refined.topology.euler_characteristic(), 2);
    EXPECT_GT(refined.topology.face_count(), 12U);
  }
}

TEST(Attributes, MeshesWithAChartPerFaceStayTiled) {
  TriangleMesh misoriented = icosahedron();
  std::swap(misoriented.triangles[3][0], misoriented.triangles[3][1]);
  TriangleMesh non_manifold = join(cube(), fan(5, false), 4);
  non_manifold.positions.push_back({0.5F, 0.5F, 3});
  non_manifold.triangles.push_back({0, 1, static_cast<uint32_t>(non_manifold.positions.size() - 1)});
  std::mt19937 random(3);
  for (const TriangleMesh& shape : {real_mesh("bunny600.obj"), torus(7, 5), grid(4, 3), misoriented, non_manifold,
                                    random_manifold(random), random_manifold(random)}) {
    const Mesh coarse = build_mesh(charted_faces(shape));
    ASSERT_EQ(coarse.attributes.point_count, coarse.topology.half_edge_count());
    for (const Options& options : ways()) {
      if (options.max_faces != 0 && coarse.topology.face_count() > options.max_faces) continue;
      expect_sound(refine(coarse, options).mesh, refine(without_attributes(coarse), options).mesh, 0.5);
    }
  }
}

TEST(Attributes, RefinementNeitherRemovesNorAddsSeams) {
  const Mesh coarse = build_mesh(charted_cube());
  for (int levels : {0, 1, 2, 3})
    for (Scheme scheme : {Scheme::red_green, Scheme::in_place}) {
      const Mesh refined = refine(coarse, {.levels = levels, .scheme = scheme}).mesh;
      EXPECT_EQ(count_seams(refined), 12U << static_cast<unsigned>(levels));
      const uint32_t side = (1U << static_cast<unsigned>(levels)) + 1;
      EXPECT_EQ(refined.attributes.point_count, 6 * side * side);
      EXPECT_EQ(refined.topology.vertex_count, 6 * (side - 1) * (side - 1) + 2);
    }
}

TEST(Attributes, AdaptiveValuesAreBitIdenticalToUniform) {
  for (const TriangleMesh& shape : {TriangleMesh(charted_cube()), TriangleMesh(charted_faces(torus(7, 5)))}) {
    const Mesh coarse = build_mesh(shape);
    std::map<std::tuple<double, double, double>, Vec3f> uniform;
    const auto collect = [&](const Mesh& mesh, auto use) {
      const TriangleMesh made = mesh.triangles();
      for (uint32_t p = 0; p < made.positions.size(); ++p)
        use(std::tuple(made.attributes[chart_number].values[p], made.attributes[chart_coordinates].values[2 * p],
                       made.attributes[chart_coordinates].values[2 * p + 1]),
            made.positions[p]);
    };
    collect(refine(coarse, {.levels = 3}).mesh, [&](auto key, Vec3f position) { uniform.emplace(key, position); });
    for (const Options& options : ways()) {
      if (options.scheme != Scheme::red_green) continue;
      collect(refine(coarse, options).mesh, [&](auto key, Vec3f position) {
        ASSERT_TRUE(uniform.contains(key));
        ASSERT_EQ(uniform[key], position);
      });
    }
  }
}

TEST(Attributes, NormalsKeepTheirLength) {
  TriangleMesh mesh = icosahedron();
  Attribute normals{3, true, {}};
  for (Vec3f p : mesh.positions) {
    const Vec3d n = (1 / length(to_double(p))) * to_double(p);
    normals.values.insert(normals.values.end(), {n.x, n.y, n.z});
  }
  mesh.attributes.push_back(normals);
  for (const Options& options : ways()) {
    const Mesh refined = refine(build_mesh(mesh), options).mesh;
    EXPECT_EQ(refined.attributes.point_count, refined.topology.vertex_count) << "a smooth attribute has no seams";
    const std::vector<double>& n = refined.attributes.attributes[0].values;
    for (size_t i = 0; i < n.size(); i += 3) ASSERT_NEAR(std::hypot(n[i], n[i + 1], n[i + 2]), 1, 1e-12);
  }
}

TEST(Attributes, OppositeNormalsAndHugeValuesStayFinite) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  mesh.attributes = {{3, true, {0, 0, 1, 0, 0, -1, 0, 0, 1}}, {1, false, {1.7e308, 1.7e308, -1.7e308}}};
  const Mesh refined = refine(build_mesh(mesh), {.levels = 2}).mesh;
  for (const Attribute& attribute : refined.attributes.attributes)
    for (double value : attribute.values) ASSERT_TRUE(std::isfinite(value));
}

TEST(Attributes, PointsWithEqualValuesAreOnePoint) {
  TriangleMesh mesh = charted_cube();
  mesh.attributes = {{2, false, std::vector<double>(48, 0.25)}};
  const Mesh built = build_mesh(mesh);
  EXPECT_EQ(built.attributes.point_count, 8U);
  EXPECT_EQ(count_seams(built), 0U);
}

TEST(Attributes, ValuesThatAreNotFiniteOrMissingAreRefused) {
  const auto fault_of = [](const TriangleMesh& mesh) {
    try {
      (void)build_mesh(mesh);
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("Attribute 1"), std::string::npos);
      return error.fault();
    }
    ADD_FAILURE() << "was not refused";
    return Fault::bad_option;
  };
  for (double value : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    TriangleMesh mesh = charted_cube();
    mesh.attributes[1].values[7] = value;
    EXPECT_EQ(fault_of(mesh), Fault::not_finite);
  }
  TriangleMesh mesh = charted_cube();
  mesh.attributes[1].values.pop_back();
  EXPECT_EQ(fault_of(mesh), Fault::index_out_of_range);
}

}  // namespace
}  // namespace papilio
