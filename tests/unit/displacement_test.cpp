#include "core/mesh/displacement.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>

#include "papilio/refine.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

Attribute displacement_attribute() {
  Attribute attribute;
  attribute.components = 3;
  attribute.is_displacement = true;
  return attribute;
}

/// Returns the mesh with random displacements of its points, up to `size` in each coordinate.
TriangleMesh displaced(TriangleMesh mesh, double size, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-size, size);
  Attribute displacement = displacement_attribute();
  for (size_t i = 0; i < 3 * mesh.positions.size(); ++i) displacement.values.push_back(number(random));
  mesh.attributes.push_back(std::move(displacement));
  return mesh;
}

Vec3d displacement_of(const Mesh& mesh, uint32_t h) {
  const double* value = &mesh.attributes.attributes.back().values[size_t{3} * mesh.attributes.point[h]];
  return {value[0], value[1], value[2]};
}

TriangleMesh moved(TriangleMesh mesh, double share) {
  const std::vector<double>& values = mesh.attributes.back().values;
  for (size_t p = 0; p < mesh.positions.size(); ++p)
    mesh.positions[p] =
        to_float(to_double(mesh.positions[p]) + share * Vec3d{values[3 * p], values[3 * p + 1], values[3 * p + 2]});
  return mesh;
}

double furthest(const Mesh& base, const Mesh& moved_base, double share) {
  EXPECT_EQ(base.topology.origin, moved_base.topology.origin);
  double most = 0;
  for (uint32_t h = 0; h < base.topology.half_edge_count(); ++h) {
    const uint32_t v = base.topology.origin[h];
    const Vec3d expected = to_double(base.positions[v]) + share * displacement_of(base, h);
    most = std::max(most, length(to_double(moved_base.positions[v]) - expected));
  }
  return most;
}

TEST(Displacement, DisplacedResultEqualsTheRefinedDisplacedMesh) {
  std::mt19937 random(1);
  int compared = 0;
  for (const TriangleMesh& shape : {icosahedron(), torus(7, 5), grid(4, 3), fan(5, false), fan(40, true), bipyramid(9),
                                    random_manifold(random), random_manifold(random), random_manifold(random)})
    for (const double w : {0.0, 0.02})
      for (const Scheme scheme : {Scheme::red_green, Scheme::in_place})
        for (const double crease_angle : {180.0, 30.0}) {
          const TriangleMesh coarse = displaced(shape, 1e-3, 5);
          const Options options{
              .levels = 3, .scheme = scheme, .tension = Tension::off, .w = w, .crease_angle = crease_angle};
          const Mesh base = refine(build_mesh(coarse), options).mesh;
          for (const double share : {1.0, -0.5}) {
            const Mesh other = refine(build_mesh(moved(coarse, share)), options).mesh;
            if (base.topology.kind != other.topology.kind) continue;  // an edge at 30 degrees
            EXPECT_LT(furthest(base, other, share), 1e-6 * bounding_box(base.positions).diagonal());
            ++compared;
          }
        }
  EXPECT_GT(compared, 120);  // of 144
}

TEST(Displacement, MostDisplacementsHoldUnderTensionAndShapeRules) {
  for (const char* name : {"bunny600.obj", "elephant2000.obj"}) {
    const TriangleMesh coarse = displaced(real_mesh(name), 1e-6, 2);
    for (const Tension tension : {Tension::soft, Tension::sharp}) {
      const Options options{.levels = 2, .tension = tension, .shape = Shape::organic};
      const Mesh base = refine(build_mesh(coarse), options).mesh;
      const Mesh other = refine(build_mesh(moved(coarse, 1)), options).mesh;
      ASSERT_EQ(base.topology.origin, other.topology.origin);
      // Factors of tension change with the positions unless they are 0 or 1, as they are at most vertices.
      const double size = bounding_box(base.positions).diagonal();
      uint64_t near = 0;
      for (uint32_t h = 0; h < base.topology.half_edge_count(); ++h) {
        const uint32_t v = base.topology.origin[h];
        const Vec3d expected = to_double(base.positions[v]) + displacement_of(base, h);
        near += length(to_double(other.positions[v]) - expected) < 1e-6 * size ? 1 : 0;
      }
      EXPECT_GT(static_cast<double>(near), 0.9 * base.topology.half_edge_count()) << name;
    }
  }
}

using Place = std::tuple<float, float, float>;

std::map<Place, Vec3d> by_place(const Mesh& mesh) {
  std::map<Place, Vec3d> all;
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h) {
    const Vec3f p = mesh.positions[mesh.topology.origin[h]];
    all[{p.x, p.y, p.z}] = displacement_of(mesh, h);
  }
  return all;
}

TEST(Displacement, DisplacementsAreBitIdenticalToUniform) {
  const TriangleMesh coarse = displaced(real_mesh("bunny600.obj"), 0.01, 3);
  for (const Tension tension : {Tension::off, Tension::soft, Tension::sharp}) {
    const std::map<Place, Vec3d> uniform = by_place(refine(build_mesh(coarse), {.levels = 3, .tension = tension}).mesh);
    const PreparedMesh prepared(build_mesh(coarse), {.tension = tension}, uint64_t{1} << 28);
    const Options view{.levels = 3, .view = View{.eye = {0, 0.1, 0.5}, .target = {0, 0.1, 0}}, .tension = tension};
    for (const Options& options : {Options{.levels = 3, .flatness = {0.8}, .tension = tension},
                                   Options{.levels = 3, .tension = tension, .tolerance = 0.002},
                                   Options{.levels = 3, .tension = tension, .max_faces = 2000}, view})
      for (const Result& result : {refine(build_mesh(coarse), options), refine(prepared, options),
                                   refine(prepared, options, {.threads = 2})}) {
        EXPECT_GT(result.mesh.topology.face_count(), 600U);
        for (const auto& [place, displacement] : by_place(result.mesh)) EXPECT_EQ(uniform.at(place), displacement);
      }
  }
}

/// Two squares that share a side; only one is displaced.
TEST(Displacement, DisplacementsStaySeparateWhereOneSideMoves) {
  TriangleMesh coarse = join(grid(2, 2), grid(2, 2), 2);
  Attribute displacement = displacement_attribute();
  for (size_t p = 0; p < coarse.positions.size(); ++p)
    displacement.values.insert(displacement.values.end(), {0, 0, p < coarse.positions.size() / 2 ? 0.0 : 1.0});
  coarse.attributes.push_back(std::move(displacement));
  const Mesh refined = refine(build_mesh(coarse), {.levels = 2, .tension = Tension::off}).mesh;
  EXPECT_EQ(refined.topology.euler_characteristic(), 1);
  for (uint32_t h = 0; h < refined.topology.half_edge_count(); ++h) {
    const Vec3f p = refined.positions[refined.topology.origin[h]];
    const Vec3f q = refined.positions[refined.topology.tip(h)];
    const Vec3f r = refined.positions[refined.topology.apex(h)];
    EXPECT_EQ(displacement_of(refined, h).z, (p.x + q.x + r.x) / 3 < 2 ? 0 : 1);
  }
}

TEST(Displacement, VertexDisplacementIsUnknownWherePointsDiffer) {
  TriangleMesh coarse = join(grid(1, 1), grid(1, 1), 1);
  Attribute displacement = displacement_attribute();
  for (size_t p = 0; p < coarse.positions.size(); ++p)
    displacement.values.insert(displacement.values.end(), {p < 4 ? 1.0 : 2.0, 0, 0});
  coarse.attributes.push_back(std::move(displacement));
  const Mesh mesh = build_mesh(coarse);
  const Displacements at_vertices = displacements_at_vertices(mesh);
  ASSERT_EQ(at_vertices.size(), 1U);
  for (uint32_t v = 0; v < mesh.topology.vertex_count; ++v) {
    const Vec3d at = at_vertices[0].at[v];
    if (mesh.positions[v].x == 1)
      EXPECT_FALSE(is_known(at));
    else
      EXPECT_EQ(at, (Vec3d{mesh.positions[v].x == 0 ? 1.0 : 2.0, 0, 0}));
  }
}

}  // namespace
}  // namespace papilio
