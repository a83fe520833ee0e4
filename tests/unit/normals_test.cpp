#include "core/mesh/normals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

/// Shapes of all sizes, some faces of which have no area, or none that is a number.
std::vector<Mesh> meshes_with_normals() {
  std::mt19937 random(5);
  std::vector<Mesh> meshes;
  for (int i = 0; i < 60; ++i) {
    TriangleMesh triangles = random_manifold(random);
    const float size = std::pow(10.0F, std::uniform_real_distribution<float>(-42, 17)(random));
    for (Vec3f& p : triangles.positions) {
      p = {size * p.x, size * p.y, size * p.z};
      if (random() % 4 == 0) p.z = p.y = 0;
    }
    meshes.push_back(build_mesh(triangles));
  }
  return meshes;
}

Vec3f face_normal(const Mesh& mesh, uint32_t face) {
  const Vec3d n = area_normal(mesh, face);
  const double size = length(n);
  return size > 0 ? to_float((1 / size) * n) : Vec3f{};
}

bool are_same_bits(Vec3f a, Vec3f b) { return std::memcmp(&a, &b, sizeof(a)) == 0; }

TEST(FaceNormals, AreThoseOfTheFacesOneByOneToTheBit) {
  size_t without = 0;
  for (const Mesh& mesh : meshes_with_normals())
    for (const int threads : {1, 2}) {
      const Buffer<Vec3f> normals = face_normals(mesh, threads);
      ASSERT_EQ(normals.size(), mesh.topology.face_count());
      for (uint32_t f = 0; f < normals.size(); ++f) {
        ASSERT_TRUE(are_same_bits(normals[f], face_normal(mesh, f))) << f;
        without += has_normal(normals[f]) ? 0 : 1;
      }
    }
  EXPECT_GT(without, 10U);
}

TEST(FaceNormals, OfFoursAreThoseAskedOf) {
  std::mt19937 random(6);
  const Mesh mesh = build_mesh(torus(16, 8));
  Buffer<uint32_t> fours;
  for (uint32_t i = 0; i < mesh.topology.face_count() / 4; ++i)
    if (random() % 2 == 0) fours.push_back(i);
  const Buffer<Vec3f> normals = face_normals(mesh, 2, &fours);
  ASSERT_EQ(normals.size(), mesh.topology.face_count());
  for (uint32_t i : fours)
    for (uint32_t f = 4 * i; f < 4 * i + 4; ++f) EXPECT_TRUE(are_same_bits(normals[f], face_normal(mesh, f))) << f;
}

}  // namespace
}  // namespace papilio
