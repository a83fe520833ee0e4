#include "core/mesh/normals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "tests/support/shapes.h"

namespace papilio {
namespace {

using namespace test;

/// Shapes of all sizes; some faces have no area or a NaN area.
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

TEST(FaceNormals, BatchedNormalsAreBitIdentical) {
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

}  // namespace
}  // namespace papilio
