#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <span>
#include <tuple>

#include "core/detail/seams.h"
#include "papilio/detail.h"
#include "papilio/error.h"
#include "papilio/refine.h"
#include "tests/support/decoded_detail.h"
#include "tests/support/packed_levels.h"
#include "tests/support/shapes.h"
#include "tests/support/textured_shapes.h"

// Colours of packed originals.

namespace papilio {
namespace {

using test::pack_levels;

/// Step of texture coordinates, 1/2048 of that of colours.
constexpr float colour_step = 1.0F / 2048;
/// Largest error at vertices: three quarters of a step.
constexpr double most_missed = 0.75;

/// Returns a colour that is a smooth function of the position.
std::array<double, 3> colour_at(Vec3d p) {
  return {std::round(128 + 100 * std::sin(3 * p.x)), std::round(128 + 100 * std::cos(2 * p.y)),
          std::round(128 + 60 * (p.z + p.x))};
}

/// Adds colours to the points of a mesh.
TriangleMesh coloured(TriangleMesh mesh) {
  Attribute colours{.components = 3, .values = {}};
  for (const Vec3f p : mesh.positions) {
    const auto colour = colour_at(to_double(p));
    colours.values.insert(colours.values.end(), colour.begin(), colour.end());
  }
  mesh.attributes.push_back(std::move(colours));
  return mesh;
}

std::array<double, 3> colour_of(const TriangleMesh& mesh, uint32_t point) {
  const double* value = &mesh.attributes.back().values[size_t{3} * point];
  return {value[0], value[1], value[2]};
}

double largest_error(const TriangleMesh& mesh) {
  double largest = 0;
  for (uint32_t p = 0; p < mesh.positions.size(); ++p) {
    const auto wanted = colour_at(to_double(mesh.positions[p]));
    const auto found = colour_of(mesh, p);
    for (size_t c = 0; c < 3; ++c) largest = std::max(largest, std::abs(found[c] - wanted[c]));
  }
  return largest;
}

TriangleMesh coloured_torus() { return coloured(test::torus(64, 32)); }

DetailSource packed_levels_of_torus() { return pack_levels(coloured_torus(), {.texcoord_step = colour_step}); }

TEST(DetailColours, DecodedColoursEqualTheOriginalsAtVertices) {
  const DetailSource source = packed_levels_of_torus();
  const TriangleMesh fine = test::decoded_triangles(source.base, source.levels);
  ASSERT_EQ(fine.attributes.size(), 1U);
  EXPECT_EQ(fine.positions.size(), build_mesh(fine).topology.vertex_count) << "no seams";
  // Colours of the original are linear between vertices: error of a quarter of the squared longest edge times
  // curvature.
  EXPECT_LT(largest_error(fine), most_missed + 4);
  size_t bytes = 0;
  for (const DetailStream& level : source.levels) bytes += level.texcoords.bytes.size();
  EXPECT_GT(bytes, 0U);
}

TEST(DetailColours, SmallerStepLowersTheError) {
  const auto error_with = [](float texcoord_step) {
    const DetailSource source = pack_levels(coloured_torus(), {.texcoord_step = texcoord_step});
    return largest_error(test::decoded_triangles(source.base, source.levels));
  };
  EXPECT_LT(error_with(colour_step), 0.5 * error_with(16 * colour_step));
}

TEST(DetailColours, OneColourTakesNoBytes) {
  TriangleMesh mesh = coloured_torus();
  std::ranges::fill(mesh.attributes[0].values, 77);
  const DetailSource source = pack_levels(mesh);
  for (const DetailStream& level : source.levels) {
    EXPECT_TRUE(level.texcoords.bytes.empty());
    EXPECT_EQ(level.texcoords.step, 0);
  }
  const TriangleMesh fine = test::decoded_triangles(source.base, source.levels);
  for (const double value : fine.attributes.at(0).values) EXPECT_NEAR(value, 77, 1e-3);
}

TEST(DetailColours, ColoursLeaveTextureCoordinatesUnchanged) {
  const TriangleMesh tube = test::textured_tube(48, 16);
  const DetailSource both = pack_levels(coloured(tube));
  const TriangleMesh fine = test::decoded_triangles(both.base, both.levels);
  ASSERT_EQ(fine.attributes.size(), 2U);
  EXPECT_LT(largest_error(fine), most_missed + 4);
  // Texture coordinates equal those packed without colours.
  const DetailSource alone = pack_levels(tube);
  const TriangleMesh uncoloured = test::decoded_triangles(alone.base, alone.levels);
  EXPECT_EQ(fine.attributes[0], uncoloured.attributes.at(0));
  EXPECT_EQ(fine.positions, uncoloured.positions);
}

TEST(DetailColours, RefinedLevelsHaveTheDecodersColours) {
  for (const bool has_texcoords : {false, true}) {
    const DetailSource source = pack_levels(has_texcoords ? coloured(test::textured_tube(48, 16)) : coloured_torus());
    Mesh base = build_mesh(source.base.triangles);
    base.attach_detail(stream_detail(source));
    const auto colours_at_places = [](const TriangleMesh& mesh) {
      std::set<std::tuple<float, float, float, float, float, float>> found;
      for (uint32_t p = 0; p < mesh.positions.size(); ++p) {
        const Vec3f at = mesh.positions[p];
        const auto [r, g, b] = colour_of(mesh, p);
        found.emplace(at.x, at.y, at.z, static_cast<float>(r), static_cast<float>(g), static_cast<float>(b));
      }
      return found;
    };
    const auto whole = colours_at_places(test::decoded_triangles(source.base, source.levels));
    Options options;
    options.levels = 4;
    EXPECT_EQ(colours_at_places(refine(base, options).mesh.triangles()), whole);
    options.max_faces = 1000;
    for (const auto& point : colours_at_places(refine(base, options).mesh.triangles()))
      EXPECT_TRUE(whole.contains(point));
  }
}

TEST(DetailColours, AnyBytesDecodeDeterministically) {
  std::mt19937 random(5);
  DetailSource source = packed_levels_of_torus();
  for (int i = 0; i < 20; ++i) {
    for (DetailStream& level : source.levels) {
      level.texcoords.step = colour_step;
      level.texcoords.bytes.resize(40);
      for (uint8_t& byte : level.texcoords.bytes) byte = static_cast<uint8_t>(random());
    }
    const auto decode = [&] { return test::decoded_triangles(source.base, source.levels); };
    EXPECT_EQ(decode(), decode());
  }
}

TEST(DetailColours, OverflowingColoursAreRefused) {
  DetailSource source = packed_levels_of_torus();
  source.levels[0].texcoords = {1e16F, {}};  // bits that are all 1
  EXPECT_THROW((void)test::decoded_triangles(source.base, source.levels), Error);
  source = packed_levels_of_torus();
  source.base.triangles.attributes[0].values[2] = 1e19;
  EXPECT_THROW((void)test::decoded_triangles(source.base, source.levels), Error);
}

}  // namespace
}  // namespace papilio
