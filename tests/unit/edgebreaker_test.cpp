#include "proto/edgebreaker/writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <utility>

#include "client/mesh_file/mesh_file.h"
#include "core/mesh/connect.h"
#include "papilio/refine.h"
#include "proto/edgebreaker/positions.h"
#include "tests/support/crowded_meshes.h"
#include "tests/support/draco_faces.h"
#include "tests/support/libdraco_writer.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"
#include "tests/support/small_surfaces.h"

// Streams written from half-edges are byte-identical to libdraco's.

namespace papilio::proto {
namespace {

using namespace test;

/// Returns whether edges have distinct pairs of vertices, no vertex is pinched, and the mesh is not two faces back to
/// back.
bool is_manifold(const Mesh& mesh) {
  const Topology& topology = mesh.topology;
  std::set<std::pair<uint32_t, uint32_t>> pairs;
  size_t edges = 0;
  for (uint32_t h = 0; h < topology.half_edge_count(); ++h) {
    pairs.insert(std::minmax(topology.origin[h], topology.tip(h)));
    edges += topology.twin[h] == none || h < topology.twin[h] ? 1 : 0;
  }
  const bool is_pillow = topology.face_count() == 2 && topology.vertex_count == 3;
  return pairs.size() == edges && find_pinched(topology).empty() && !is_pillow;
}

/// Returns whether the bytes equal libdraco's. Otherwise expects a non-manifold mesh and the faces of libdraco's
/// stream.
bool is_the_same(const Mesh& mesh, const OutputOptions& options, const MeshFormat& format = {}) {
  const QuantizationBox box = quantization_box(mesh.positions);
  const std::vector<OutputAttribute> attributes = output_attributes(mesh, attribute_encoding(mesh, format));
  const std::string own = edgebreaker::write(mesh, box, options, 3, attributes);
  const std::string libdracos = write_with_libdraco(mesh, box, options, 3, attributes);
  if (own == libdracos) return true;
  EXPECT_TRUE(!is_manifold(mesh) && faces_of(own) == faces_of(libdracos))
      << mesh.topology.face_count() << " faces, speed " << options.speed << ", bits " << options.position_bits;
  return false;
}

TEST(Edgebreaker, BytesEqualLibdracosOnShapes) {
  for (const TriangleMesh& shape :
       {tetrahedron(), icosahedron(), cube(), torus(3, 3), torus(7, 5), grid(1, 1), grid(4, 3), fan(1, false),
        fan(5, true), fan(40, false), bipyramid(3), bipyramid(50), square_ring(4, 1, 2, 0.5F),
        join(torus(5, 4), grid(2, 2), 5), box({9, 7, 8}, {3, 2, 1})})
    for (int speed = 0; speed <= 10; ++speed)
      for (int bits = 8; bits <= 16; ++bits)
        EXPECT_TRUE(is_the_same(build_mesh(shape), {.position_bits = bits, .speed = speed}));
}

TEST(Edgebreaker, BytesEqualLibdracosOnRandomManifolds) {
  std::mt19937 random(5);
  int own = 0;
  for (int i = 0; i < 4000; ++i) {
    const OutputOptions options{.position_bits = 8 + i % 9, .speed = i % 8};
    own += is_the_same(build_mesh(random_manifold(random)), options) ? 1 : 0;
  }
  EXPECT_GT(own, 3000);
}

// The valence traversal needs many faces.
TEST(Edgebreaker, BytesEqualLibdracosOnLargeRandomManifolds) {
  std::mt19937 random(17);
  int own = 0;
  for (int i = 0; i < 150; ++i) {
    Mesh mesh = build_mesh(random_manifold(random));
    while (mesh.topology.face_count() < 1000) mesh = refine(std::move(mesh), {.levels = 1}).mesh;
    own += is_the_same(mesh, {.position_bits = 11, .speed = i % 5}) ? 1 : 0;
  }
  EXPECT_GT(own, 100);
}

TEST(Edgebreaker, BytesEqualLibdracosOnRefinedRealMeshes) {
  for (const char* name : {"bunny600.obj", "elephant2000.obj"}) {
    const Mesh coarse = build_mesh(real_mesh(name));
    for (int levels = 0; levels <= 3; ++levels)
      for (int speed : {0, 1, 3, 7}) {
        EXPECT_TRUE(is_the_same(refine(coarse, {.levels = levels}).mesh, {.position_bits = 11, .speed = speed}));
        const Options adaptive{.levels = levels, .tolerance = 1e-4, .edges = false};
        EXPECT_TRUE(is_the_same(refine(coarse, adaptive).mesh, {.position_bits = 14, .speed = speed}));
      }
  }
}

// Sanitizers take ten times as long and get smaller meshes only.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr uint32_t most_round_trip_faces = 30'000;
#else
constexpr uint32_t most_round_trip_faces = 300'000;
#endif

class EdgebreakerAtSpeed : public testing::TestWithParam<int> {};

TEST_P(EdgebreakerAtSpeed, BytesEqualLibdracosOnAllLevelsOfAllRealMeshes) {
  int same = 0;
  int others = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(std::getenv("PAPILIO_MESHES")) / "cgal")) {
    Mesh mesh;
    try {
      mesh = build_mesh(client::read_triangles(entry.path(), client::format_of(entry.path())));
      (void)quantization_box(mesh.positions);
    } catch (const std::exception&) {
      continue;  // every_real_mesh_test covers unreadable and tiny meshes
    }
    SCOPED_TRACE(entry.path());
    const uint32_t most =
        GetParam() < 2 ? most_round_trip_faces / 1000 : most_round_trip_faces;  // libdraco is slow there
    for (int level = 0; level <= 3 && mesh.topology.face_count() <= most; ++level) {
      if (level > 0) mesh = refine(std::move(mesh), {.levels = 1}).mesh;
      ++(is_the_same(mesh, {.position_bits = 11, .speed = GetParam()}) ? same : others);
    }
  }
  EXPECT_GT(same, 8 * others);
  RecordProperty("same", same);
  RecordProperty("others", others);
}

INSTANTIATE_TEST_SUITE_P(Edgebreaker, EdgebreakerAtSpeed, testing::Values(0, 1, 3, 7));

MeshFormat every_format() {
  using enum AttributeKind;
  using enum ValueType;
  MeshFormat format;
  format.attributes = {{.kind = normal, .id = 1},
                       {.kind = tex_coord, .id = 7},
                       {.kind = color, .type = uint8, .normalized = true, .id = 0},
                       {.kind = generic, .type = int16, .id = 300},
                       {.kind = tex_coord, .id = 2},
                       {.kind = normal, .type = int8, .id = 9},
                       {.kind = color, .id = 11}};
  return format;
}
constexpr std::array<uint32_t, 7> components_of_every_format{3, 2, 4, 1, 3, 3, 4};

/// Assigns each face to a random chart, and each corner the values of its vertex in that chart.
TriangleMesh with_attributes(const TriangleMesh& mesh, uint32_t charts, std::mt19937& random) {
  TriangleMesh out;
  std::vector<std::vector<double>> values(components_of_every_format.size());
  const MeshFormat format = every_format();
  for (const Triangle& t : mesh.triangles) {
    const uint32_t chart = random() % charts;
    out.triangles.push_back({});
    Triangle& face = out.triangles.back();
    for (uint32_t i = 0; i < 3; ++i) {
      face[i] = static_cast<uint32_t>(out.positions.size());
      out.positions.push_back(mesh.positions[t[i]]);
      for (size_t a = 0; a < values.size(); ++a) {
        std::mt19937 of_value(1000 * t[i] + 10 * static_cast<uint32_t>(a) + (a + 1 == values.size() ? 0 : chart));
        std::vector<double> value(components_of_every_format[a]);
        for (double& number : value) number = static_cast<double>(of_value() % 256) / 256 - 0.5;
        if (format.attributes[a].type != ValueType::float32)
          for (double& number : value) number = std::floor(100 * (number + 0.5));
        values[a].insert(values[a].end(), value.begin(), value.end());
      }
    }
  }
  for (size_t a = 0; a < values.size(); ++a)
    out.attributes.push_back({.components = components_of_every_format[a], .values = values[a]});
  return out;
}

TEST(Edgebreaker, BytesEqualLibdracosWithAttributes) {
  std::mt19937 random(7);
  int with_seams = 0;
  for (const TriangleMesh& shape : {tetrahedron(), icosahedron(), torus(9, 7), grid(1, 1), grid(6, 5), fan(7, true),
                                    bipyramid(5), square_ring(4, 1, 2, 0.5F), join(torus(5, 4), grid(2, 2), 5)})
    for (uint32_t charts : {1U, 2U, 5U}) {
      const Mesh mesh = build_mesh(with_attributes(shape, charts, random));
      with_seams += mesh.attributes.point_count > mesh.topology.vertex_count ? 1 : 0;
      for (int speed = 0; speed <= 10; ++speed)
        EXPECT_TRUE(is_the_same(mesh, {.position_bits = 11, .speed = speed}, every_format()));
    }
  EXPECT_GT(with_seams, 10);
}

TEST(Edgebreaker, BytesEqualLibdracosWithAttributesOnRandomManifolds) {
  std::mt19937 random(11);
  int own = 0;
  for (int i = 0; i < 1000; ++i) {
    const Mesh mesh = build_mesh(with_attributes(random_manifold(random), 1 + random() % 4, random));
    const OutputOptions options{.position_bits = 8 + i % 9, .speed = i % 11};
    own += is_the_same(mesh, options, every_format()) ? 1 : 0;
  }
  EXPECT_GT(own, 700);
}

TEST(Edgebreaker, BytesEqualLibdracosWithAttributesOfRefinedMeshes) {
  std::mt19937 random(13);
  const Mesh coarse = build_mesh(with_attributes(real_mesh("bunny600.obj"), 2, random));
  for (int levels = 1; levels <= 2; ++levels)
    for (int speed : {0, 1, 2, 3, 4, 5, 6, 7, 9}) {
      EXPECT_TRUE(is_the_same(refine(coarse, {.levels = levels}).mesh, {.speed = speed}, every_format()));
      const Options adaptive{.levels = levels, .tolerance = 1e-3, .edges = false};
      EXPECT_TRUE(is_the_same(refine(coarse, adaptive).mesh, {.speed = speed}, every_format()));
    }
}

TEST(Edgebreaker, BytesEqualLibdracosWithNewNormals) {
  const MeshFormat format{.attributes = {{.kind = AttributeKind::normal, .id = 1}}};
  for (const TriangleMesh& shape : {icosahedron(), torus(40, 30), grid(40, 3), cube(), square_ring(12, 0.5F, 1, 0.4F)})
    for (int speed = 0; speed <= 10; ++speed) {
      Mesh mesh = refine(build_mesh(shape), {.levels = 1}).mesh;
      add_normals(mesh);
      EXPECT_TRUE(is_the_same(mesh, {.speed = speed}, format));
    }
}

// Covers several fans at a vertex and two faces with the same vertices.
TEST(Edgebreaker, BytesEqualLibdracosOnEverySmallSurface) {
  for (uint32_t triangles = 1; triangles <= 8; ++triangles)
    for (const TriangleMesh& surface : small_surfaces(triangles))
      for (int speed : {0, 2, 5, 8})
        EXPECT_TRUE(is_the_same(build_mesh(surface), {.position_bits = 12, .speed = speed}));
}

TEST(Edgebreaker, BytesEqualLibdracosWithAttributesOfEveryKind) {
  TriangleMesh triangles = tetrahedron();
  const auto write = [&](const AttributeFormat& format, double largest = 1) {
    triangles.attributes = {{.components = 1, .values = {0, 0, 1, largest}}};
    for (int speed : {0, 3, 7}) EXPECT_TRUE(is_the_same(build_mesh(triangles), {.speed = speed}, {0, {format}}));
  };
  write({});
  write({.type = ValueType::int32});
  write({}, 1e39);
  write({.type = ValueType::float64});
  write({.type = ValueType::int64});
  write({.type = ValueType::boolean});
  write({.kind = AttributeKind::normal});  // one component
  write({.id = 77, .name = "weight"});
}

// libdraco then codes no attribute with its entropy coder; this writer still codes the others.
TEST(Edgebreaker, IntegersTooLargeForTheEntropyCoderAreWritten) {
  TriangleMesh triangles = tetrahedron();
  const std::vector<double> large{0, -(1 << 21), 1 << 30, 77};
  triangles.attributes = {{.components = 1, .values = large}, {.components = 1, .values = {3, 5, 8, 9}}};
  const MeshFormat format{.attributes = {{.type = ValueType::int32, .id = 1}, {.type = ValueType::int8, .id = 2}}};
  const Mesh mesh = build_mesh(triangles);
  const QuantizationBox box = quantization_box(mesh.positions);
  for (int speed : {0, 3, 7}) {
    const std::vector<OutputAttribute> attributes = output_attributes(mesh, attribute_encoding(mesh, format));
    EXPECT_EQ(faces_of(edgebreaker::write(mesh, box, {.speed = speed}, 0, attributes)),
              faces_of(write_with_libdraco(mesh, box, {.speed = speed}, 0, attributes)));
  }
}

TEST(Edgebreaker, BytesEqualLibdracosWithExactValues) {
  std::mt19937 random(19);
  for (int i = 0; i < 300; ++i) {
    const TriangleMesh plain = random_manifold(random);
    const TriangleMesh coloured = with_attributes(plain, 1 + random() % 3, random);
    if (!is_manifold(build_mesh(plain))) continue;
    EXPECT_TRUE(write_draco_exact(plain) == write_exact_with_libdraco(plain));
    EXPECT_TRUE(write_draco_exact(coloured, every_format()) == write_exact_with_libdraco(coloured, every_format()));
  }
}

TEST(Edgebreaker, CrowdedMeshesKeepTheirFaces) {
  for (const TriangleMesh& triangles : {faces_at_one_edge(300), triangles_at_one_vertex(300), shuffled_cone(300)})
    for (int speed : {0, 1, 3, 7})
      for (int levels : {0, 2})
        (void)is_the_same(refine(build_mesh(triangles), {.levels = levels}).mesh, {.speed = speed});
}

TEST(Edgebreaker, NonManifoldMeshesKeepTheirAttributes) {
  std::mt19937 random(29);
  int others = 0;
  for (int i = 0; i < 60; ++i) {
    TriangleMesh triangles = i % 2 == 0 ? faces_at_one_edge(3 + i) : triangles_at_one_vertex(2 + i);
    if (i % 3 == 0) triangles = join(triangles, random_manifold(random), 1);  // faces may touch there
    const Mesh mesh = build_mesh(with_attributes(triangles, 1 + random() % 3, random));
    others += is_the_same(refine(mesh, {.levels = i % 2}).mesh, {.speed = i % 11}, every_format()) ? 0 : 1;
  }
  EXPECT_GT(others, 20);
}

TEST(Edgebreaker, ThrowingPollStopsTheWriterAtAnyCall) {
  const Mesh mesh = build_mesh(torus(330, 200));
  const QuantizationBox box = quantization_box(mesh.positions);
  for (int speed : {0, 3, 7}) {
    int calls = 0;
    (void)edgebreaker::write(mesh, box, {.speed = speed}, 0, {}, [&] { ++calls; });
    EXPECT_GT(calls, 6);
    for (int last = 1; last <= calls; last += 3) {
      int left = last;
      EXPECT_THROW((void)edgebreaker::write(mesh, box, {.speed = speed}, 0, {},
                                            [&] {
                                              if (--left == 0) throw std::runtime_error("stopped");
                                            }),
                   std::runtime_error);
      EXPECT_EQ(left, 0);
    }
  }
}

// The fourth lane held the x of the next vertex, which overflowed.
TEST(Edgebreaker, FourthLaneOfGridPointsIsZeroFarFromTheOrigin) {
  TriangleMesh far = grid(8, 8);
  for (Vec3f& p : far.positions) p.x += 800'000;
  const Mesh mesh = build_mesh(far);
  const edgebreaker::Surface surface = edgebreaker::manifold_surface(mesh.topology);
  for (const edgebreaker::GridPoint& p :
       edgebreaker::to_grid(mesh.positions, surface, quantization_box(mesh.positions), 16))
    EXPECT_EQ(p[3], 0);
}

}  // namespace
}  // namespace papilio::proto
