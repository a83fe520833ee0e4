#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "proto/detail/level_table.h"
#include "proto/detail/pack.h"
#include "proto/detail/packed_reader.h"
#include "proto/problem.h"
#include "tests/support/decoded_detail.h"
#include "tests/support/gltf_scene.h"
#include "tests/support/packed_model.h"
#include "tests/support/shapes.h"
#include "tests/support/textured_shapes.h"

// Packed models whose levels have several pieces: table, order in the file, truncated files.

namespace papilio::proto::detail {
namespace {

using test::in_pieces;
using test::packed_fixture;
using test::PackedFixture;

PackedFixture levels_in_pieces() { return in_pieces(packed_fixture(test::icosahedron(), 3), {1, 3, 20}); }
PackedFixture textured_levels_in_pieces() { return in_pieces(packed_fixture(test::charted_box(2), 3), {2, 1, 7}); }

/// First byte of the table in the file.
size_t begin_of_table(const PackedFixture& made) {
  return made.glb.size() - test::binary_of_glb(made.glb).size() + made.base_stream.size();
}
/// Offset of the table of pieces, after the rows.
constexpr size_t pieces_at = 18 + 3 * 20;
constexpr size_t count_at = 18 + 20 + 16;  // of the second level's pieces

/// Returns the file with another number in its table.
std::string with_number(const PackedFixture& made, size_t at, uint32_t number) {
  std::string glb = made.glb;
  for (unsigned i = 0; i < 4; ++i) glb[begin_of_table(made) + at + i] = static_cast<char>(number >> (8 * i) & 0xFF);
  return glb;
}
std::string with_number(const PackedFixture& made, size_t at, float number) {
  return with_number(made, at, std::bit_cast<uint32_t>(number));
}

std::string refusal_of_pieces(const std::string& glb) {
  try {
    (void)read_packed(glb);
    return "read";
  } catch (const Problem& problem) {
    return std::string(problem_kind(problem.code()).name);
  }
}

TEST(PackedPieces, PiecesRoundTripExactly) {
  for (const PackedFixture& made : {levels_in_pieces(), textured_levels_in_pieces()}) {
    const PackedModel model = read_packed(made.glb);
    ASSERT_EQ(model.levels.size(), 3U);
    for (size_t l = 0; l < 3; ++l) {
      EXPECT_EQ(model.levels[l].stream.pieces, made.detail.levels[l].pieces) << l;
      EXPECT_EQ(model.levels[l].stream.bytes, made.detail.levels[l].bytes) << l;
      EXPECT_EQ(model.levels[l].stream.texcoords.bytes, made.detail.levels[l].texcoords.bytes) << l;
      EXPECT_EQ(model.levels[l].missing_pieces, 0U);
    }
  }
}

TEST(PackedPieces, OnePiecePerLevelHasNoPieceTable) {
  const PackedFixture made = packed_fixture(test::icosahedron(), 3);
  EXPECT_EQ(in_pieces(made, {1, 1, 1}).glb, made.glb);
}

TEST(PackedPieces, PieceTableOfWholeLevelsRoundTrips) {
  const PackedFixture made = packed_fixture(test::icosahedron(), 2);
  LevelTable table = read_table(std::string_view(made.glb).substr(begin_of_table(made)));
  EXPECT_FALSE(table.has_pieces);
  const uint64_t before = table.size();
  table.has_pieces = true;
  const std::string counted = write_table(table);
  EXPECT_EQ(counted.size(), before + 2 * 4);
  EXPECT_EQ(size_of_rows(counted), counted.size());
  EXPECT_EQ(size_of_table(counted), counted.size());
  const LevelTable again = read_table(counted);
  EXPECT_EQ(again.total(), table.total());
  EXPECT_TRUE(again.has_pieces && again.rows[0].pieces.empty() && again.rows[1].pieces.empty());
}

/// Each piece has its residuals followed by its texture coordinates.
TEST(PackedPieces, PiecesAreStoredConsecutively) {
  const PackedFixture made = textured_levels_in_pieces();
  const DetailStream& last = made.detail.levels[2];
  std::string expected;
  auto residuals = last.bytes.begin();
  auto texcoords = last.texcoords.bytes.begin();
  for (const DetailPiece& piece : last.pieces) {
    expected.append(residuals, residuals + piece.bytes);
    expected.append(texcoords, texcoords + piece.texcoord_bytes);
    residuals += piece.bytes;
    texcoords += piece.texcoord_bytes;
  }
  EXPECT_NE(made.glb.find(expected), std::string::npos);
}

TEST(PackedPieces, PrefixGivesItsCompletePieces) {
  for (const PackedFixture& made : {levels_in_pieces(), textured_levels_in_pieces()}) {
    const LevelTable table = read_table(std::string_view(made.glb).substr(begin_of_table(made)));
    size_t end = begin_of_table(made) + table.size();
    for (size_t l = 0; l < 3; ++l) {
      const DetailStream& level = made.detail.levels[l];
      const size_t count = std::max<size_t>(1, level.pieces.size());
      for (size_t p = 0; p < count; ++p) {
        const size_t bytes = level.pieces.empty() ? level.bytes.size() + level.texcoords.bytes.size()
                                                  : level.pieces[p].bytes + level.pieces[p].texcoord_bytes;
        for (const size_t size : {end, end + bytes - 1}) {  // p pieces of this level
          const PackedModel model = read_packed(made.glb.substr(0, size), {.may_be_cut = true});
          ASSERT_EQ(model.levels.size(), p == 0 ? l : l + 1) << l << ' ' << p;
          EXPECT_EQ(reach_of(model).rms, l == 0 ? model.base_reach.rms : table.rows[l - 1].reach.rms);
          if (p == 0) continue;
          const PackedLevel& last = model.levels.back();
          EXPECT_EQ(last.missing_pieces, count - p);
          EXPECT_EQ(last.stream.pieces[p - 1], level.pieces[p - 1]);
          EXPECT_TRUE(last.stream.pieces[p].is_missing);
          const TriangleMesh decoded = test::decoded_triangles(model.base, model.streams());
          EXPECT_EQ(decoded.triangles.size(), model.levels.back().faces);
        }
        end += bytes;
      }
    }
  }
}

TEST(PackedPieces, InvalidCountsAreRefused) {
  const PackedFixture made = levels_in_pieces();
  EXPECT_EQ(refusal_of_pieces(with_number(made, count_at, 3U)), "read");
  for (const uint32_t count : {0U, 1U, 2U, 4U, 65535U, 65536U, 0xFFFFFFFFU})
    EXPECT_EQ(refusal_of_pieces(with_number(made, count_at, count)), "mesh_not_gltf") << count;
  const PackedFixture many = in_pieces(packed_fixture(test::tetrahedron(), 1), {5});  // of 4 faces
  EXPECT_EQ(refusal_of_pieces(many.glb), "mesh_not_gltf");
}

TEST(PackedPieces, InvalidByteCountsAreRefused) {
  const PackedFixture made = levels_in_pieces();
  const uint32_t bytes = made.detail.levels[1].pieces[0].bytes;
  EXPECT_EQ(refusal_of_pieces(with_number(made, pieces_at, bytes)), "read");
  for (const uint32_t other : {0U, bytes + 1, 0xFFFFFFFFU})
    EXPECT_EQ(refusal_of_pieces(with_number(made, pieces_at, other)), "mesh_not_gltf") << other;
}

TEST(PackedPieces, InvalidBoundsAreRefused) {
  const PackedFixture made = levels_in_pieces();
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const auto refused = [&](size_t number, const std::vector<float>& values) {
    for (const float value : values)
      EXPECT_EQ(refusal_of_pieces(with_number(made, pieces_at + 4 * number, value)), "mesh_not_gltf")
          << number << ' ' << value;
  };
  for (size_t number = 1; number < 10; ++number) refused(number, {infinity, -infinity, std::nanf("")});
  refused(1, {-0.1F});                                                      // the largest move
  refused(5, {-0.1F});                                                      // the radius
  for (const size_t number : {6, 7, 8, 9}) refused(number, {-1.1F, 1.1F});  // axis and cosine
  EXPECT_EQ(refusal_of_pieces(with_number(made, pieces_at + 4 * 9, -1.0F)), "read");
}

TEST(PackedPieces, DescriptionCountsPiecesAndMissingPieces) {
  const auto described = [](const std::string& glb) {
    return test::GltfScene::Json::parse(describe(read_packed(glb, {.may_be_cut = true})));
  };
  const PackedFixture made = levels_in_pieces();
  const auto whole = described(made.glb);
  EXPECT_FALSE(whole["levels"][0].contains("pieces"));
  EXPECT_EQ(whole["levels"][2]["pieces"], 20);
  EXPECT_FALSE(whole["levels"][2].contains("missing_pieces"));
  EXPECT_EQ(described(made.glb.substr(0, made.glb.size() - 5))["levels"][2]["missing_pieces"], 2);
}

}  // namespace
}  // namespace papilio::proto::detail
