#include "proto/edgebreaker/writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <tuple>
#include <utility>

#include "client/mesh_file/mesh_file.h"
#include "core/refine.h"
#include "proto/draco_reader.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"
#include "tests/support/small_surfaces.h"

// Written from the half-edges, to the byte as libdraco writes it.

namespace papilio::proto {
namespace {

using namespace test;

/// False where libdraco has to write it.
bool is_the_same(const Mesh& mesh, const OutputOptions& options, const MeshFormat& format = {}) {
  const QuantizationBox box = quantization_box(mesh.positions);
  const std::vector<OutputAttribute> attributes = output_attributes(mesh, options, attribute_encoding(mesh, format));
  const std::optional<std::string> own = edgebreaker::write(mesh, box, options, 3, attributes);
  if (!own) return false;
  EXPECT_TRUE(*own == write_with_libdraco(mesh, box, options, 3, attributes))
      << mesh.topology.face_count() << " faces, speed " << options.speed << ", bits " << options.position_bits;
  return true;
}

TEST(Edgebreaker, IsLibdracosOnShapes) {
  for (const TriangleMesh& shape :
       {tetrahedron(), icosahedron(), cube(), torus(3, 3), torus(7, 5), grid(1, 1), grid(4, 3), fan(1, false),
        fan(5, true), fan(40, false), bipyramid(3), bipyramid(50), square_ring(4, 1, 2, 0.5F),
        join(torus(5, 4), grid(2, 2), 5), box({9, 7, 8}, {3, 2, 1})})
    for (int speed = 2; speed <= 10; ++speed)
      for (int bits = 8; bits <= 16; ++bits)
        EXPECT_TRUE(is_the_same(build_mesh(shape), {.position_bits = bits, .speed = speed}));
}

TEST(Edgebreaker, IsLibdracosOnRandomManifolds) {
  std::mt19937 random(5);
  int own = 0;
  for (int i = 0; i < 4000; ++i) {
    const OutputOptions options{.position_bits = 8 + i % 9, .speed = 2 + i % 6};
    own += is_the_same(build_mesh(random_manifold(random)), options) ? 1 : 0;
  }
  EXPECT_GT(own, 3000);
}

// Few faces are never coded by valence.
TEST(Edgebreaker, IsLibdracosOnRandomManifoldsOfManyFaces) {
  std::mt19937 random(17);
  int own = 0;
  for (int i = 0; i < 150; ++i) {
    Mesh mesh = build_mesh(random_manifold(random));
    while (mesh.topology.face_count() < 1000) mesh = refine(std::move(mesh), {.levels = 1}).mesh;
    own += is_the_same(mesh, {.position_bits = 11, .speed = 2 + i % 3}) ? 1 : 0;
  }
  EXPECT_GT(own, 100);
}

TEST(Edgebreaker, IsLibdracosOnRefinedRealMeshes) {
  for (const char* name : {"bunny600.obj", "elephant2000.obj"}) {
    const Mesh coarse = build_mesh(real_mesh(name));
    for (int levels = 0; levels <= 3; ++levels)
      for (int speed : {3, 7}) {
        EXPECT_TRUE(is_the_same(refine(coarse, {.levels = levels}).mesh, {.position_bits = 11, .speed = speed}));
        const Options adaptive{.levels = levels, .tolerance = 1e-4, .edges = false};
        EXPECT_TRUE(is_the_same(refine(coarse, adaptive).mesh, {.position_bits = 14, .speed = speed}));
      }
  }
}

// Under sanitizers, which take ten times as long, only what is not too large.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr uint32_t most_faces = 30'000;
#else
constexpr uint32_t most_faces = 10'000'000;
#endif

class EdgebreakerAtSpeed : public testing::TestWithParam<int> {};

TEST_P(EdgebreakerAtSpeed, IsLibdracosOnAllRealMeshesInAllLevels) {
  int own = 0;
  int left = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(std::getenv("PAPILIO_MESHES")) / "cgal")) {
    Mesh mesh;
    try {
      mesh = build_mesh(client::read_triangles(entry.path(), client::format_of(entry.path())));
      (void)quantization_box(mesh.positions);
    } catch (const std::exception&) {
      continue;  // every_real_mesh_test looks at what cannot be read, or is too small
    }
    SCOPED_TRACE(entry.path());
    for (int level = 0; level <= 3 && mesh.topology.face_count() <= most_faces; ++level) {
      if (level > 0) mesh = refine(std::move(mesh), {.levels = 1}).mesh;
      ++(is_the_same(mesh, {.position_bits = 11, .speed = GetParam()}) ? own : left);
    }
  }
  EXPECT_GT(own, 8 * left);
  RecordProperty("own", own);
  RecordProperty("left_to_libdraco", left);
}

INSTANTIATE_TEST_SUITE_P(Edgebreaker, EdgebreakerAtSpeed, testing::Values(3, 7));

/// Of everything that is written from the half-edges. (The rest is `LeavesToLibdraco...`.)
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

/// Gives each corner values of its vertex and of one of `charts` charts, which its face belongs to by chance.
TriangleMesh with_attributes(const TriangleMesh& mesh, uint32_t charts, std::mt19937& random) {
  TriangleMesh out;
  std::vector<std::vector<double>> values(components_of_every_format.size());
  const MeshFormat format = every_format();
  for (const Triangle& t : mesh.triangles) {
    const uint32_t chart = random() % charts;
    Triangle& face = out.triangles.emplace_back();
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

TEST(Edgebreaker, IsLibdracosWithAttributes) {
  std::mt19937 random(7);
  int with_seams = 0;
  for (const TriangleMesh& shape : {tetrahedron(), icosahedron(), torus(9, 7), grid(1, 1), grid(6, 5), fan(7, true),
                                    bipyramid(5), square_ring(4, 1, 2, 0.5F), join(torus(5, 4), grid(2, 2), 5)})
    for (uint32_t charts : {1U, 2U, 5U}) {
      const Mesh mesh = build_mesh(with_attributes(shape, charts, random));
      with_seams += mesh.attributes.point_count > mesh.topology.vertex_count ? 1 : 0;
      for (int speed = 2; speed <= 10; ++speed)
        for (bool normals : {false, true})
          EXPECT_TRUE(is_the_same(mesh, {.position_bits = 11, .speed = speed, .normals = normals}, every_format()));
    }
  EXPECT_GT(with_seams, 10);
}

TEST(Edgebreaker, IsLibdracosWithAttributesOnRandomManifolds) {
  std::mt19937 random(11);
  int own = 0;
  for (int i = 0; i < 1000; ++i) {
    const Mesh mesh = build_mesh(with_attributes(random_manifold(random), 1 + random() % 4, random));
    const OutputOptions options{.position_bits = 8 + i % 9, .speed = 2 + i % 9};
    own += is_the_same(mesh, options, every_format()) ? 1 : 0;
  }
  EXPECT_GT(own, 700);
}

TEST(Edgebreaker, IsLibdracosWithAttributesOfRefinedMeshes) {
  std::mt19937 random(13);
  const Mesh coarse = build_mesh(with_attributes(real_mesh("bunny600.obj"), 2, random));
  for (int levels = 1; levels <= 2; ++levels)
    for (int speed : {2, 3, 4, 5, 6, 7, 9}) {
      EXPECT_TRUE(is_the_same(refine(coarse, {.levels = levels}).mesh, {.speed = speed}, every_format()));
      const Options adaptive{.levels = levels, .tolerance = 1e-3, .edges = false};
      EXPECT_TRUE(is_the_same(refine(coarse, adaptive).mesh, {.speed = speed}, every_format()));
    }
}

TEST(Edgebreaker, IsLibdracosWithNewNormals) {
  for (const TriangleMesh& shape : {icosahedron(), torus(40, 30), grid(40, 3)})
    for (int speed = 2; speed <= 10; ++speed)
      EXPECT_TRUE(is_the_same(build_mesh(shape), {.speed = speed, .normals = true}));
}

/// What a decoder makes of a stream: each face by the grid points of its corners, in no order.
std::vector<std::array<Vec3f, 3>> faces_of(const std::string& draco) {
  const TriangleMesh mesh = read_draco(draco, {});
  const auto before = [](Vec3f a, Vec3f b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
  std::vector<std::array<Vec3f, 3>> faces;
  for (const Triangle& t : mesh.triangles) {
    std::array<Vec3f, 3> face{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
    std::ranges::rotate(face, std::ranges::min_element(face, before));
    faces.push_back(face);
  }
  std::ranges::sort(faces,
                    [&](const auto& a, const auto& b) { return std::ranges::lexicographical_compare(a, b, before); });
  return faces;
}

/// Each edge between two vertices of its own, each face (there may be two sides of one) between three, and one fan of
/// faces at each vertex.
bool is_manifold(const Mesh& mesh) {
  std::set<std::pair<uint32_t, uint32_t>> pairs;
  for (uint32_t h = 0; h < mesh.topology.half_edge_count(); ++h)
    pairs.insert(std::minmax(mesh.topology.origin[h], mesh.topology.tip(h)));
  const bool is_pillow = mesh.topology.face_count() == 2 && mesh.topology.vertex_count == 3;
  return pairs.size() == mesh.topology.edge_count() && mesh.topology.pinched.empty() && !is_pillow;
}

TEST(Edgebreaker, IsLibdracosOnEverySmallSurface) {
  int own = 0;
  for (uint32_t triangles = 1; triangles <= 8; ++triangles)
    for (const TriangleMesh& surface : small_surfaces(triangles)) {
      const Mesh mesh = build_mesh(surface);
      const QuantizationBox box = quantization_box(mesh.positions);
      for (int speed : {2, 5, 8}) {
        const OutputOptions options{.position_bits = 12, .speed = speed};
        const bool is_own = is_the_same(mesh, options);
        EXPECT_EQ(is_own, is_manifold(mesh));
        own += is_own ? 1 : 0;
        if (is_own) continue;
        const std::string written = write_draco(mesh, box, options);
        EXPECT_EQ(faces_of(written), faces_of(write_with_libdraco(mesh, box, options, 0)));
        EXPECT_EQ(faces_of(written).size(), mesh.topology.face_count());
      }
    }
  EXPECT_GT(own, 2000);
}

TEST(Edgebreaker, LeavesToLibdracoAttributesOfOtherKinds) {
  TriangleMesh triangles = tetrahedron();
  const auto is_left = [&](const AttributeFormat& format, double largest = 1) {
    triangles.attributes = {{.components = 1, .values = {0, 0, 1, largest}}};
    return !is_the_same(build_mesh(triangles), {}, {.attributes = {format}});
  };
  EXPECT_FALSE(is_left({}));
  EXPECT_FALSE(is_left({.type = ValueType::int32}));
  EXPECT_TRUE(is_left({.type = ValueType::int32}, 1 << 21));
  EXPECT_TRUE(is_left({}, 1e39));
  EXPECT_TRUE(is_left({.type = ValueType::float64}));
  EXPECT_TRUE(is_left({.type = ValueType::int64}));
  EXPECT_TRUE(is_left({.type = ValueType::boolean}));
  EXPECT_TRUE(is_left({.kind = AttributeKind::normal}));  // of one component
  EXPECT_TRUE(is_left({.name = "weight"}));
}

TEST(Edgebreaker, LeavesToLibdracoWhatDracoSeesOtherwise) {
  const auto is_left = [](const TriangleMesh& triangles, const OutputOptions& options = {}) {
    const Mesh mesh = build_mesh(triangles);
    const QuantizationBox box = quantization_box(mesh.positions);
    bool by_libdraco = false;
    const std::string written = write_draco(mesh, box, options, {}, &by_libdraco);
    EXPECT_EQ(read_draco(written, {}).triangles.size(), triangles.triangles.size());
    EXPECT_EQ(by_libdraco, !edgebreaker::write(mesh, box, options, 0));
    return by_libdraco;
  };
  EXPECT_FALSE(is_left(tetrahedron()));
  EXPECT_FALSE(is_left(tetrahedron(), {.normals = true}));
  EXPECT_TRUE(is_left(tetrahedron(), {.speed = 1}));
  TriangleMesh three{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}}};
  EXPECT_TRUE(is_left(three));  // faces at one edge
  TriangleMesh touching{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
  EXPECT_TRUE(is_left(touching));  // at a vertex
  TriangleMesh pillow{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}};
  EXPECT_TRUE(is_left(pillow));  // the same two vertices at several edges, once refined
}

}  // namespace
}  // namespace papilio::proto
