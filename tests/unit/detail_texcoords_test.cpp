#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <set>
#include <span>
#include <tuple>

#include "core/detail/base_points.h"
#include "core/detail/collapse_sequence.h"
#include "core/detail/level_decoder.h"
#include "core/detail/manifold_surface.h"
#include "core/detail/seams.h"
#include "papilio/detail.h"
#include "papilio/error.h"
#include "papilio/refine.h"
#include "tests/support/decoded_detail.h"
#include "tests/support/packed_levels.h"
#include "tests/support/shapes.h"
#include "tests/support/textured_shapes.h"

// Texture coordinates of packed originals: seams of the base, prediction, residuals.

namespace papilio {
namespace {

using test::box_texcoord;
using test::charted_box;
using test::flat_sheet;
using test::pack_levels;
using test::sheet_texcoord;
using test::Texcoord;
using test::texcoord_at;
using test::textured_tube;
using test::with_texcoords;

constexpr float usual_step = 1.0F / 2048;
constexpr double largest_miss = 0.75 / 2048;

TriangleMesh decode_all(const DetailSource& source) { return test::decoded_triangles(source.base, source.levels); }
size_t texcoord_bytes(const DetailSource& source) {
  size_t bytes = 0;
  for (const DetailStream& level : source.levels) bytes += level.texcoords.bytes.size();
  return bytes;
}

/// Returns the largest error of texture coordinates at the points of a mesh and at the centres of its faces.
/// `error(position, texcoord, normal)` returns the error of one, given the normal of its face.
double largest_error(const TriangleMesh& mesh, const std::function<double(Vec3d, Texcoord, Vec3d)>& error) {
  double largest = 0;
  for (const Triangle& t : mesh.triangles) {
    std::array<Vec3d, 3> p{};
    std::array<Texcoord, 3> c{};
    for (size_t i = 0; i < 3; ++i) p[i] = to_double(mesh.positions[t[i]]), c[i] = texcoord_at(mesh, t[i]);
    const Vec3d normal = cross(p[1] - p[0], p[2] - p[0]);
    for (size_t i = 0; i < 3; ++i) largest = std::max(largest, error(p[i], c[i], normal));
    const Texcoord middle{(c[0][0] + c[1][0] + c[2][0]) / 3, (c[0][1] + c[1][1] + c[2][1]) / 3};
    largest = std::max(largest, error((1 / 3.0) * (p[0] + p[1] + p[2]), middle, normal));
  }
  return largest;
}

double texcoord_distance(Texcoord a, Texcoord b) { return std::max(std::abs(a[0] - b[0]), std::abs(a[1] - b[1])); }

double error_on_tube(Vec3d p, Texcoord c, Vec3d /*normal*/) {
  const double turn = std::atan2(p.y, p.x) / (2 * std::numbers::pi);
  const double off = c[0] - turn;  // an integer if exact
  return std::max(std::abs(off - std::round(off)), std::abs(c[1] - std::clamp(p.z / 2, 0.0, 1.0)));
}

/// Returns the error at a position on the box. Folded faces may have the opposite normal.
double error_on_box(Vec3d p, Texcoord c, Vec3d normal) {
  return std::min(texcoord_distance(c, box_texcoord(normal, p)), texcoord_distance(c, box_texcoord(-1.0 * normal, p)));
}

int64_t euler_characteristic_of_charts(const Mesh& mesh) {
  return cut_at_seams(mesh, seam_edges(mesh)).topology.euler_characteristic();
}

TEST(Seams, TubeHasOneSeamAtItsCut) {
  const Mesh mesh = build_mesh(textured_tube(20, 7));
  EXPECT_EQ(seam_edges(mesh).size(), 7U);
  EXPECT_EQ(mesh.topology.euler_characteristic(), 0);
  EXPECT_EQ(euler_characteristic_of_charts(mesh), 1) << "a disc";
}

TEST(Seams, SeamsOfABoxSeparateItsSides) {
  const Mesh mesh = build_mesh(charted_box(4));
  EXPECT_EQ(seam_edges(mesh).size(), 12U * 4);
  const CutSurface cut = cut_at_seams(mesh, seam_edges(mesh));
  EXPECT_EQ(cut.topology.vertex_count, 6U * 25);
  EXPECT_EQ(cut.topology.euler_characteristic(), 6);
  EXPECT_EQ(cut.topology.shape.corners.size(), 6U * 4);
  for (uint32_t h = 0; h < cut.topology.half_edge_count(); ++h) {
    const uint32_t first = cut.half_edge[cut.topology.origin[h]];
    EXPECT_EQ(mesh.topology.origin[h], mesh.topology.origin[first]);
    EXPECT_EQ(mesh.attributes.point[h], mesh.attributes.point[first]);
  }
}

TEST(Seams, MeshWithoutAttributesHasNoSeams) { EXPECT_TRUE(seam_edges(build_mesh(test::cube())).empty()); }

TEST(Seams, InnerEndOfASeamIsOneVertex) {
  // A closed fan of six, cut along one spoke: two points at its rim vertex, one at the centre.
  const TriangleMesh fan = test::fan(6, true);
  const Mesh mesh = build_mesh(with_texcoords(fan, [&](const Triangle& t, size_t i) {
    const bool is_first = t == fan.triangles[0];
    const Vec3f p = fan.positions[t[i]];
    const bool is_cut = is_first && p.x > 0.99F;
    return Texcoord{p.x + (is_cut ? 1.0 : 0.0), p.y};
  }));
  EXPECT_EQ(seam_edges(mesh).size(), 1U);
  const CutSurface cut = cut_at_seams(mesh, seam_edges(mesh));
  EXPECT_EQ(cut.topology.vertex_count, 8U);
  EXPECT_EQ(cut.topology.shape.corners.size(), 3U) << "both ends of the cut, one of them twice";
}

TEST(CollapseSequence, CollapsesKeepSeamsAndTheirTexcoords) {
  for (const bool is_box : {true, false}) {
    const Mesh original = build_mesh(is_box ? charted_box(10) : textured_tube(40, 20));
    CollapseSequence sequence(original);
    for (const uint32_t faces : {300U, 100U, 0U}) {
      sequence.collapse_to(faces);
      const BaseMesh base = sequence.base();
      const TriangleMesh points = points_of_base(base, original);
      const Mesh mesh = build_mesh(points);
      EXPECT_LE(mesh.topology.face_count(), std::max(faces, 60U));
      EXPECT_NO_THROW(require_manifold(mesh));
      EXPECT_EQ(euler_characteristic_of_charts(mesh), euler_characteristic_of_charts(original));
      for (uint32_t p = 0; p < points.positions.size(); ++p) {
        const Texcoord texcoord = texcoord_at(points, p);
        const Vec3f at = points.positions[p];
        bool is_known = false;
        for (uint32_t h = 0; h < original.topology.half_edge_count() && !is_known; ++h) {
          const double* value = &original.attributes.attributes[0].values[size_t{2} * original.attributes.point[h]];
          is_known = original.positions[original.topology.origin[h]] == at &&
                     texcoord_distance(texcoord, {value[0], value[1]}) == 0;
        }
        EXPECT_TRUE(is_known);
      }
    }
  }
}

TEST(DetailTexcoords, FlatSheetTakesNoBytes) {
  const DetailSource made = pack_levels(flat_sheet(20));
  EXPECT_EQ(texcoord_bytes(made), 0U);
  EXPECT_LT(largest_error(decode_all(made),
                          [](Vec3d p, Texcoord c, Vec3d) { return texcoord_distance(c, sheet_texcoord(p)); }),
            1e-6);
}

TEST(DetailTexcoords, ChartsOfABoxStayAccurateAndClosed) {
  const DetailSource made = pack_levels(charted_box(8));
  EXPECT_EQ(texcoord_bytes(made), 0U);
  const TriangleMesh fine = decode_all(made);
  EXPECT_LT(largest_error(fine, error_on_box), largest_miss);
  const Mesh mesh = build_mesh(fine);
  EXPECT_NO_THROW(require_manifold(mesh));
  EXPECT_EQ(mesh.topology.euler_characteristic(), 2) << "closed at its seams";
  EXPECT_EQ(euler_characteristic_of_charts(mesh), 6);
}

TEST(DetailTexcoords, TubeIsAccurateOnBothSidesOfItsCut) {
  const DetailSource made = pack_levels(textured_tube(48, 16));
  const TriangleMesh fine = decode_all(made);
  EXPECT_LT(largest_error(fine, error_on_tube), 1.5 * largest_miss);
  for (const Triangle& t : fine.triangles)
    for (size_t i = 0; i < 3; ++i)
      EXPECT_LT(std::abs(texcoord_at(fine, t[i])[0] - texcoord_at(fine, t[(i + 1) % 3])[0]), 0.2)
          << "no face spans the cut";
  const Mesh mesh = build_mesh(fine);
  EXPECT_NO_THROW(require_manifold(mesh));
  EXPECT_EQ(mesh.topology.euler_characteristic(), 0);
  EXPECT_EQ(euler_characteristic_of_charts(mesh), 1);
}

TEST(DetailTexcoords, SmallerStepLowersTheError) {
  const TriangleMesh original = textured_tube(48, 16);
  double before = 1;
  for (const float step : {1.0F / 128, 1.0F / 512, 1.0F / 2048}) {
    const double error = largest_error(decode_all(pack_levels(original, {.texcoord_step = step})), error_on_tube);
    EXPECT_LT(error, 0.5 * before);
    EXPECT_GT(error, 0.1 * step);
    before = error;
  }
}

TEST(DetailTexcoords, SmoothSeamIsNoCrease) {
  EXPECT_EQ(std::ranges::count(mesh_of_base(pack_levels(textured_tube(48, 16)).base).topology.kind, EdgeKind::crease),
            0);
}

TEST(DetailTexcoords, SkippedTexcoordsLeaveTheSurfaceUnchanged) {
  DetailSource made = pack_levels(textured_tube(48, 16));
  const TriangleMesh whole = decode_all(made);
  ASSERT_GT(texcoord_bytes(made), 0U);
  for (DetailStream& level : made.levels) level.texcoords = {};
  const TriangleMesh skipped = decode_all(made);
  EXPECT_EQ(skipped.positions, whole.positions);
  EXPECT_EQ(skipped.triangles, whole.triangles);
  EXPECT_NE(skipped.attributes, whole.attributes);
  EXPECT_LT(largest_error(skipped, error_on_tube), 0.05);
}

TEST(DetailTexcoords, AnyBytesDecodeDeterministically) {
  DetailSource made = pack_levels(charted_box(6), {.levels = 3, .step = 1e-3F});
  std::mt19937 random(9);
  for (int round = 0; round < 20; ++round) {
    for (DetailStream& level : made.levels) {
      level.texcoords.step = 0.01F;
      level.texcoords.bytes.resize(random() % 60);
      for (uint8_t& byte : level.texcoords.bytes) byte = static_cast<uint8_t>(random());
    }
    const TriangleMesh fine = decode_all(made);
    EXPECT_EQ(fine, decode_all(made));
    for (const double value : fine.attributes.at(0).values) EXPECT_TRUE(std::isfinite(value));
  }
}

TEST(DetailTexcoords, OverflowingTexcoordsAreRefused) {
  DetailSource made = pack_levels(charted_box(6), {.levels = 2, .step = 1e-3F});
  for (DetailStream& level : made.levels) level.texcoords = {1e18F, {}};  // bits that are all 1
  EXPECT_THROW((void)decode_all(made), Error);
  for (DetailStream& level : made.levels) level.texcoords = {-1, {}};
  EXPECT_THROW((void)decode_all(made), Error);
}

TEST(DetailTexcoords, EncoderWritesAndCountsTexcoords) {
  const DetailOptions options{.rms = 5e-3, .face_limit = 2000};
  const EncodedDetail made =
      encode_detail(textured_tube(32, 8), options, [](const TriangleMesh& base, std::span<const Vec3d> normals) {
        EXPECT_TRUE(normals.empty()) << "vertices must not slide off their texture coordinates";
        return CodedBase{base, 9 * base.positions.size()};
      });
  EXPECT_EQ(made.base.triangles.attributes.size(), 1U);
  uint64_t bytes = 0;
  for (const DetailStream& level : made.levels) bytes += level.texcoords.bytes.size();
  EXPECT_EQ(made.texcoord_bytes, bytes);
  EXPECT_LT(largest_error(test::decoded_triangles(made.base, made.levels), error_on_tube), 0.01);
}

/// Texture coordinates of all points, with their positions.
std::set<std::tuple<float, float, float, float, float>> texcoords_at_places(const TriangleMesh& mesh) {
  std::set<std::tuple<float, float, float, float, float>> found;
  for (uint32_t p = 0; p < mesh.positions.size(); ++p) {
    const auto [u, v] = texcoord_at(mesh, p);
    const Vec3f at = mesh.positions[p];
    found.emplace(at.x, at.y, at.z, static_cast<float>(u), static_cast<float>(v));
  }
  return found;
}

Mesh with_levels(const DetailSource& source) {
  Mesh mesh = build_mesh(source.base.triangles);
  mesh.attach_detail(stream_detail(source));
  return mesh;
}

TEST(DetailTexcoords, RefinedLevelsHaveTheDecodersTexcoords) {
  for (const bool is_box : {true, false}) {
    const DetailSource source = pack_levels(is_box ? charted_box(8) : textured_tube(48, 16));
    Options options;
    for (options.levels = 0; options.levels <= 4; ++options.levels) {
      const auto levels = std::span(source.levels).first(static_cast<size_t>(options.levels));
      EXPECT_EQ(texcoords_at_places(refine(with_levels(source), options).mesh.triangles()),
                texcoords_at_places(test::decoded_triangles(source.base, levels)));
    }
  }
}

TEST(DetailTexcoords, AdaptiveTexcoordsEqualTheDecoders) {
  const DetailSource source = pack_levels(textured_tube(48, 16));
  const auto whole = texcoords_at_places(decode_all(source));
  for (const uint64_t faces : {300U, 1500U}) {
    Options options;
    options.levels = 4;
    options.max_faces = faces;
    const TriangleMesh chosen = refine(with_levels(source), options).mesh.triangles();
    ASSERT_GT(chosen.triangles.size(), faces / 2);
    for (const auto& point : texcoords_at_places(chosen)) EXPECT_TRUE(whole.contains(point));
  }
}

TEST(DetailTexcoords, LevelsBelowTheLastInterpolateTexcoords) {
  const DetailSource source = pack_levels(textured_tube(48, 16), {.levels = 3});
  Options options;
  options.levels = 4;
  EXPECT_LT(largest_error(refine(with_levels(source), options).mesh.triangles(), error_on_tube), 0.01);
}

TEST(DetailTexcoords, OtherAttributesAreRefused) {
  const TriangleMesh box = charted_box(3);
  const auto expect_refused = [](const TriangleMesh& mesh) {
    EXPECT_THROW((void)encode_detail(mesh, {},
                                     [](const TriangleMesh& base, std::span<const Vec3d>) {
                                       return CodedBase{base, 1};
                                     }),
                 Error);
    EXPECT_THROW((void)test::decoded_triangles({mesh}, {}), Error);
  };
  TriangleMesh mesh = box;
  mesh.attributes.push_back(mesh.attributes[0]);
  expect_refused(mesh);
  Attribute parts{.components = 1, .values = std::vector<double>(mesh.positions.size())};
  mesh.attributes = {parts, box.attributes[0]};
  expect_refused(mesh);
  mesh.attributes = {box.attributes[0], parts};
  EXPECT_NO_THROW((void)test::decoded_triangles({mesh}, {}));
  mesh.attributes[1].values[0] = 1;
  expect_refused(mesh);
}

TEST(ManifoldSurface, SeparatedFansKeepTheirAttributes) {
  // Two boxes that touch at an edge.
  TriangleMesh one = charted_box(2);
  TriangleMesh two = one;
  for (Vec3f& p : two.positions) p = {1 + p.x, 1 + p.y, p.z};
  const auto points = static_cast<uint32_t>(one.positions.size());
  one.positions.insert(one.positions.end(), two.positions.begin(), two.positions.end());
  for (const Triangle& t : two.triangles) one.triangles.push_back({t[0] + points, t[1] + points, t[2] + points});
  one.attributes[0].values.insert(one.attributes[0].values.end(), two.attributes[0].values.begin(),
                                  two.attributes[0].values.end());
  const ManifoldSurface parted = manifold_surface(one, 1e-4);
  EXPECT_EQ(parted.parted, 3U);
  EXPECT_EQ(euler_characteristic_of_charts(parted.mesh), 12);
  EXPECT_LT(largest_error(parted.mesh.triangles(),
                          [](Vec3d p, Texcoord c, Vec3d normal) {
                            return std::min(error_on_box(p, c, normal), error_on_box(p - Vec3d{1, 1, 0}, c, normal));
                          }),
            1e-3);
}

}  // namespace
}  // namespace papilio
