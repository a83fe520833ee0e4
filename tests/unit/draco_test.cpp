#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "papilio/refine.h"
#include "proto/draco_header.h"
#include "proto/draco_reader.h"
#include "proto/draco_writer.h"
#include "proto/problem.h"
#include "tests/support/draco_tools.h"
#include "tests/support/invariants.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"

namespace papilio::proto {
namespace {

using namespace test;

Code code_of(std::string_view bytes, const Limits& limits = {}) {
  try {
    (void)read_draco(bytes, limits);
  } catch (const Problem& problem) {
    EXPECT_GT(std::string(problem.what()).size(), 20U);
    return problem.code();
  }
  ADD_FAILURE() << "was not refused";
  return Code::internal;
}

Buffer<Vec3f> sorted(Buffer<Vec3f> positions) {
  std::ranges::sort(positions, [](Vec3f a, Vec3f b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
  return positions;
}

TEST(DracoReader, BothMethodsAndMetadataAreRead) {
  const TriangleMesh mesh = icosahedron();
  for (Method method : {Method::edgebreaker, Method::sequential}) {
    for (bool metadata : {false, true}) {
      const std::string bytes = encode_with_draco(mesh, method, metadata);
      const DracoHeader header = read_draco_header(bytes, {});
      EXPECT_EQ(header.edgebreaker, method == Method::edgebreaker);
      EXPECT_EQ(header.faces, 20U);
      EXPECT_EQ(header.vertices, 12U);
      const Mesh read = build_mesh(read_draco(bytes, {}));
      EXPECT_EQ(read.topology.face_count(), 20U);
      EXPECT_EQ(read.topology.euler_characteristic(), 2);
    }
  }
}

TEST(DracoReader, OtherBytesAreRefused) {
  EXPECT_EQ(code_of(""), Code::mesh_not_draco);
  EXPECT_EQ(code_of("solid cube"), Code::mesh_not_draco);
  EXPECT_EQ(code_of("DRACO"), Code::mesh_not_draco);
  EXPECT_EQ(code_of(std::string("DRACO\2\2\1\1\0\0", 11)), Code::mesh_not_draco);
  EXPECT_EQ(code_of(std::string("DRACO\2\2\1\7\0\0\0\0\0\0", 15)), Code::mesh_not_draco);
}

TEST(DracoReader, OtherVersionsAndPointCloudsAreRefused) {
  std::string bytes = encode_with_draco(cube(), Method::edgebreaker);
  bytes[5] = 1;
  EXPECT_EQ(code_of(bytes), Code::mesh_unsupported);
  bytes[5] = 2;
  bytes[6] = 1;
  EXPECT_EQ(code_of(bytes), Code::mesh_unsupported);
  EXPECT_EQ(code_of(encode_point_cloud(cube())), Code::mesh_unsupported);
}

TEST(DracoReader, DeclaredCountsAboveTheLimitsAreRefused) {
  const std::string bytes = encode_with_draco(icosahedron(), Method::edgebreaker);
  EXPECT_EQ(code_of(bytes, {.max_input_faces = 19}), Code::mesh_too_large);
  EXPECT_EQ(code_of(bytes, {.max_input_vertices = 11}), Code::mesh_too_large);
  EXPECT_NO_THROW((void)read_draco(bytes, {.max_input_faces = 20, .max_input_vertices = 12}));
  // 68 bytes declare 2^27 faces. They are refused before the decoder allocates gigabytes.
  EXPECT_EQ(code_of(std::string("DRACO\2\2\1\1\0\0\0\xff\xff\xff\x3f\xff\xff\xff\x3f", 20) + std::string(48, '\0')),
            Code::mesh_too_large);
}

TEST(DracoReader, EveryTruncationIsRefused) {
  const std::string bytes = encode_with_draco(icosahedron(), Method::edgebreaker);
  for (size_t size = 0; size < bytes.size(); ++size)
    EXPECT_EQ(code_of(bytes.substr(0, size)), Code::mesh_not_draco) << size << " of " << bytes.size();
}

TEST(DracoReader, DamagedStreamsGiveIndicesInRangeOrAProblem) {
  for (Method method : {Method::edgebreaker, Method::sequential}) {
    const std::string bytes = encode_with_draco(join(torus(5, 5), grid(3, 3), 5), method, true);
    std::mt19937 random(1);
    for (int i = 0; i < 3000; ++i) {
      std::string damaged = bytes;
      for (uint32_t n = 1 + random() % 4; n > 0; --n) damaged[random() % damaged.size()] = static_cast<char>(random());
      try {
        const TriangleMesh mesh = read_draco(damaged, {.max_input_faces = 10000, .max_input_vertices = 10000});
        for (const Triangle& t : mesh.triangles)
          for (uint32_t v : t) ASSERT_LT(v, mesh.positions.size());
      } catch (const Problem& problem) {
        EXPECT_NE(problem.code(), Code::internal);
      }
    }
  }
}

TEST(DracoWriter, DecodedMeshIsWithinHalfAGridStep) {
  for (const TriangleMesh& shape : {icosahedron(), torus(7, 5), grid(4, 3), join(cube(), fan(5, false), 4)}) {
    const Mesh mesh = build_mesh(shape);
    const QuantizationBox box = quantization_box(mesh.positions);
    for (int bits : {8, 11, 14, 16}) {
      for (int speed : {0, 3, 5, 7, 10}) {
        const std::string bytes = write_draco(mesh, box, {.position_bits = bits, .speed = speed});
        EXPECT_TRUE(read_draco_header(bytes, {}).edgebreaker);
        const TriangleMesh decoded = decode_with_draco_decoder(bytes);
        ASSERT_EQ(decoded.triangles.size(), shape.triangles.size());
        ASSERT_EQ(euler_characteristic(decoded), mesh.topology.euler_characteristic());
        const double half_step = box.range / std::pow(2.0, bits) * 0.51 * std::sqrt(3.0);
        for (Vec3f p : decoded.positions) {
          double nearest = 1e9;
          for (Vec3f q : mesh.positions) nearest = std::min(nearest, length(to_double(p) - to_double(q)));
          ASSERT_LE(nearest, half_step) << bits << ' ' << speed;
        }
      }
    }
  }
}

TEST(DracoWriter, CoarsePositionsAreUnchangedInFinerLevels) {
  const Mesh coarse = build_mesh(real_mesh("bunny600.obj"));
  const QuantizationBox box = quantization_box(coarse.positions);
  const Buffer<Vec3f> first = sorted(read_draco(write_draco(coarse, box, {}), {}).positions);
  const Result fine = refine(coarse, {.levels = 2});
  const Buffer<Vec3f> second = sorted(read_draco(write_draco(fine.mesh, box, {}), {}).positions);
  EXPECT_TRUE(std::ranges::includes(
      second, first, [](Vec3f a, Vec3f b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }));
}

TEST(DracoWriter, PositionsOutsideTheBoxAreWithinAGridStep) {
  const Mesh mesh = build_mesh(icosahedron());
  const QuantizationBox box{{-0.5F, -0.5F, -0.5F}, 1};  // the mesh extends to 1.6 in all directions
  const TriangleMesh decoded = decode_with_draco_decoder(write_draco(mesh, box, {.position_bits = 16}));
  for (Vec3f p : decoded.positions) {
    double nearest = 1e9;
    for (Vec3f q : mesh.positions) nearest = std::min(nearest, length(to_double(p) - to_double(q)));
    EXPECT_LE(nearest, 2e-5);
  }
}

TEST(DracoWriter, TinyAndHugeMeshesKeepTheirShape) {
  for (float scale : {1e-25F, 1e-7F, 1e-6F, 1e6F, 1e17F}) {
    TriangleMesh shape = icosahedron();
    for (Vec3f& p : shape.positions) p = scale * (p + Vec3f{3, 0, 0});
    const Mesh mesh = build_mesh(shape);
    const TriangleMesh read = read_draco(write_draco(mesh, quantization_box(mesh.positions), {}), {});
    EXPECT_EQ(build_mesh(read).topology.face_count(), 20U) << scale;
    for (Vec3f p : read.positions) {
      double nearest = 1e30;
      for (Vec3f q : mesh.positions) nearest = std::min(nearest, length(to_double(p) - to_double(q)));
      EXPECT_LE(nearest, 3e-4 * scale) << scale;
    }
  }
  try {
    (void)quantization_box({{0, 0, 0}, {1e-35F, 0, 0}});
    FAIL() << "was not refused";
  } catch (const Problem& problem) {
    EXPECT_EQ(problem.code(), Code::mesh_unusable);
  }
}

TEST(DracoWriter, ExactPositionsRoundTripBitIdentically) {
  for (const TriangleMesh& mesh : {real_mesh("bunny600.obj"), icosahedron(), grid(3, 3)}) {
    const TriangleMesh read = read_draco(write_draco_exact(mesh), {});
    EXPECT_EQ(sorted(read.positions), sorted(mesh.positions));
    EXPECT_EQ(read.triangles.size(), mesh.triangles.size());
  }
}

TEST(DracoWriter, RandomManifoldsKeepFacesAndEulerCharacteristic) {
  for (uint32_t seed = 0; seed < 100; ++seed) {
    std::mt19937 random(seed);
    const Mesh mesh = build_mesh(random_manifold(random));
    const std::string bytes = write_draco(mesh, quantization_box(mesh.positions), {.position_bits = 16});
    const TriangleMesh read = read_draco(bytes, {});
    ASSERT_EQ(read.triangles.size(), mesh.topology.face_count());
    // Draco splits a pinched vertex into a point for each fan; welding merges the points.
    ASSERT_EQ(build_mesh(read).topology.euler_characteristic(), mesh.topology.euler_characteristic()) << seed;
  }
}

TEST(QuantizationBox, BoxIsACubePaddedByAnEighth) {
  const QuantizationBox box = quantization_box(grid(8, 2).positions);
  EXPECT_FLOAT_EQ(box.range, 10);
  EXPECT_EQ(box.origin, (Vec3f{-1, -4, -5}));
}

}  // namespace
}  // namespace papilio::proto
