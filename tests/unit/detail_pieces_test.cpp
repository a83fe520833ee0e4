#include "core/detail/pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/detail/level_decoder.h"
#include "papilio/error.h"
#include "papilio/refine.h"
#include "tests/support/decoded_detail.h"
#include "tests/support/packed_levels.h"
#include "tests/support/real_mesh.h"
#include "tests/support/shapes.h"
#include "tests/support/streamed_detail.h"
#include "tests/support/textured_shapes.h"

// Pieces of packed levels: dependencies, independence of other pieces, and bounds.

namespace papilio {
namespace {

/// Returns [level][piece] whether decode_detail() decodes the piece.
std::vector<std::vector<uint8_t>> decodable_pieces(const DetailBase& base, std::span<const DetailStream> levels) {
  const Mesh mesh = mesh_of_base(base);
  const PieceOrder order(mesh);
  PieceNeeds needs(mesh.topology.vertex_count);
  std::vector<std::vector<uint8_t>> made;
  for (const DetailStream& stream : levels) made.push_back(needs.next(order, pieces_of(stream)));
  return made;
}

/// Removes the bytes of the pieces for which `is_missing(level, piece)` holds.
template <class IsMissing>
DetailSource without(DetailSource source, const IsMissing& is_missing) {
  for (size_t l = 0; l < source.levels.size(); ++l) {
    DetailStream& level = source.levels[l];
    level.pieces = pieces_of(level);
    std::vector<uint8_t> bytes, texcoord_bytes;
    auto from = level.bytes.begin();
    auto from_texcoord = level.texcoords.bytes.begin();
    for (size_t p = 0; p < level.pieces.size(); ++p) {
      DetailPiece& piece = level.pieces[p];
      const auto end = from + piece.bytes;
      const auto end_texcoord = from_texcoord + piece.texcoord_bytes;
      piece.is_missing = is_missing(l, p);
      if (piece.is_missing) {
        piece.bytes = piece.texcoord_bytes = 0;
      } else {
        bytes.insert(bytes.end(), from, end);
        texcoord_bytes.insert(texcoord_bytes.end(), from_texcoord, end_texcoord);
      }
      from = end;
      from_texcoord = end_texcoord;
    }
    level.bytes = std::move(bytes);
    level.texcoords.bytes = std::move(texcoord_bytes);
  }
  return source;
}

/// Returns whether the mesh is a valid base: manifold.
bool is_manifold(const TriangleMesh& base) {
  try {
    (void)mesh_of_base({base, {}});
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::bad_surface);
    return false;
  }
}

/// Bends the sides of a shape and keeps its hard edges.
TriangleMesh bent(TriangleMesh shape) {
  for (Vec3f& p : shape.positions)
    p += 0.1F * Vec3f{std::sin(5 * p.y) * std::cos(4 * p.z), std::sin(6 * p.z + p.x), std::cos(5 * p.x - 3 * p.y)};
  return shape;
}

/// Compares the vertices of decodable pieces, if others are missing, with the complete result. Returns the number of
/// vertices compared.
uint64_t expect_same_where_decoded(const DetailSource& some, const DetailSource& all) {
  const Mesh base = mesh_of_base(all.base);
  const auto is_decoded = decodable_pieces(some.base, some.levels);
  const PieceOrder order(base);
  LevelDecoder decoder(base, true), whole(base, true);
  uint64_t compared = 0;
  for (size_t l = 0; l < all.levels.size(); ++l) {
    const Topology t = decoder.topology();
    (void)whole.topology();
    decoder.decode(some.levels[l]);
    whole.decode(all.levels[l]);
    const auto number = static_cast<uint32_t>(l);
    const EdgePieces edges = order.edges(t, number, static_cast<uint32_t>(is_decoded[l].size()));
    for (uint32_t e = 0; e < t.edge_count(); ++e) {
      if (is_decoded[l][edges.of_edge[e]] == 0) continue;
      ++compared;
      EXPECT_EQ(decoder.positions()[t.vertex_count + e], whole.positions()[t.vertex_count + e]) << l << ' ' << e;
    }
    if (decoder.values() == nullptr) continue;
    const Buffer<Texcoord> got = decoder.values()->on_half_edges<2>();
    const Buffer<Texcoord> expected = whole.values()->on_half_edges<2>();
    for (uint32_t h = 0; h < t.half_edge_count(); ++h) {
      if (is_decoded[l][edges.of_edge[t.edge[h]]] == 0) continue;
      EXPECT_EQ(got[h], expected[h]) << l << ' ' << h;
    }
  }
  return compared;
}

/// On random surfaces: closed and open, of one component and several, with irregular vertices of all kinds.
TEST(DetailPieces, DecodedBitsDoNotDependOnOtherPieces) {
  std::mt19937 random(20);
  uint64_t compared = 0;
  for (int round = 0; round < 60; ++round) {
    const TriangleMesh base = test::random_manifold(random);
    if (!is_manifold(base)) continue;
    const auto faces = static_cast<uint32_t>(base.triangles.size());
    std::vector<uint32_t> counts;
    for (int l = 0; l < 3; ++l) counts.push_back(1 + random() % std::min(faces, 12U));
    const DetailSource all = test::detail_of_residuals(
        base, 3, 0.1F, [&](int, uint32_t, Vec3f) { return static_cast<int32_t>(random() % 7) - 3; }, counts);
    const uint32_t share = random() % 4;
    const DetailSource some =
        without(all, [&](size_t l, size_t) { return random() % 8 < (l == 0 ? share / 2 : share); });
    compared += expect_same_where_decoded(some, all);
  }
  EXPECT_GT(compared, 20'000U);
}

TEST(DetailPieces, CurvesAndTextureCoordinatesAreInPieces) {
  std::mt19937 random(21);
  for (const TriangleMesh& shape : {test::charted_box(16), test::textured_tube(48, 32)}) {
    const DetailSource all = test::pack_levels(bent(shape), {.step = 1e-3F, .piece_bytes = 60});
    EXPECT_GT(all.levels.back().pieces.size(), 4U);
    for (int round = 0; round < 10; ++round) {
      const DetailSource some = without(all, [&](size_t l, size_t) { return l > 0 && random() % 6 == 0; });
      EXPECT_GT(expect_same_where_decoded(some, all), 0U);
    }
  }
}

TEST(DetailPieces, MissingPieceLosesDependentPiecesOfTheNextLevel) {
  const auto residual = [](int l, uint32_t e, Vec3f) { return static_cast<int32_t>(e + l) % 3 - 1; };
  const DetailSource all = test::detail_of_residuals(test::torus(24, 12), 2, 0.05F, residual, {12, 12});
  int in_part = 0;
  for (size_t missing = 0; missing < 12; ++missing) {
    const auto decoded =
        decodable_pieces(all.base, without(all, [&](size_t l, size_t p) { return l == 0 && p == missing; }).levels);
    EXPECT_EQ(std::ranges::count(decoded[0], 0), missing == 0 ? 12 : 1);  // all models start from the first piece's
    EXPECT_EQ(decoded[1][missing], 0);
    const auto lost = std::ranges::count(decoded[1], 0);
    EXPECT_GT(lost, 1);
    EXPECT_EQ(lost == 12, decoded[1][0] == 0);
    if (lost < 12) ++in_part;
  }
  EXPECT_GT(in_part, 4);
}

TEST(DetailPieces, LevelsWithoutPiecesEqualTheButterfly) {
  const DetailSource all =
      test::detail_of_residuals(test::torus(12, 8), 2, 0.1F, [](int, uint32_t, Vec3f) { return 1; }, {5, 7});
  const DetailSource none = without(all, [](size_t, size_t) { return true; });
  Options options;
  options.levels = 2;
  options.shape = Shape::plain;
  options.tension = Tension::off;
  const Mesh smooth = refine(build_mesh(all.base.triangles), options).mesh;
  EXPECT_EQ(decode_detail(none.base, none.levels).positions, smooth.positions);
  EXPECT_NE(decode_detail(all.base, all.levels).positions, smooth.positions);
}

/// The last level in groups of about 32 faces of the base.
TEST(DetailPieces, PiecesTakeFewMoreBytesThanOneStream) {
  const TriangleMesh bunny = test::real_mesh("bunny.obj");
  const auto packed = [&](uint64_t piece_bytes) {
    const float step = 3e-4F * bounding_box(bunny.positions).diagonal();
    return test::pack_levels(bunny, {.base_faces = 200, .step = step, .piece_bytes = piece_bytes});
  };
  const DetailSource one = packed(1'000'000);
  const DetailSource pieces = packed(600);
  EXPECT_EQ(test::decoded_triangles(one.base, one.levels).positions,
            test::decoded_triangles(pieces.base, pieces.levels).positions);
  EXPECT_GE(pieces.levels.back().pieces.size(), 6U);
  const auto bytes_of = [](const DetailSource& source) {
    double bytes = 0;
    for (const DetailStream& level : source.levels) bytes += static_cast<double>(level.bytes.size());
    return bytes;
  };
  EXPECT_LT(bytes_of(pieces), 1.02 * bytes_of(one));
}

/// Sphere and cone contain the faces of the last level; the largest move bounds the moves of each piece.
TEST(DetailPieces, StatedBoundsHold) {
  for (const TriangleMesh& shape : {test::torus(96, 48), test::charted_box(16), test::textured_tube(48, 32)}) {
    const DetailSource all = test::pack_levels(bent(shape), {.base_faces = 90, .levels = 3, .piece_bytes = 100});
    const Mesh base = mesh_of_base(all.base);
    const PieceOrder order(base);
    const TriangleMesh fine = test::decoded_triangles(all.base, all.levels);
    for (uint32_t l = 0; l < all.levels.size(); ++l) {
      const std::vector<DetailPiece>& pieces = all.levels[l].pieces;
      const auto count = static_cast<uint32_t>(pieces.size());
      if (count == 0) continue;
      for (uint32_t f = 0; f < fine.triangles.size(); ++f) {
        const PieceBounds& bounds = pieces[order.piece_of(f >> (2 * all.levels.size()), count)].bounds;
        const Triangle& t = fine.triangles[f];
        const Vec3d a = to_double(fine.positions[t[0]]);
        const Vec3d normal = cross(to_double(fine.positions[t[1]]) - a, to_double(fine.positions[t[2]]) - a);
        for (const uint32_t v : t)
          ASSERT_LE(length(to_double(fine.positions[v]) - to_double(bounds.centre)), bounds.radius);
        ASSERT_GE(dot(normal, to_double(bounds.axis)), bounds.least_cosine * length(normal) - 1e-12);
      }
      LevelDecoder moved(base), smooth(base);
      const DetailSource none = without(all, [&](size_t level, size_t) { return level == l; });
      for (uint32_t k = 0; k <= l; ++k) {
        moved.decode(all.levels[k]);
        smooth.decode(none.levels[k]);
      }
      LevelDecoder before(base);
      for (uint32_t k = 0; k < l; ++k) before.decode(all.levels[k]);
      const Topology t = before.topology();
      const EdgePieces edges = order.edges(t, l, count);
      float largest = 0;
      for (uint32_t e = 0; e < t.edge_count(); ++e) {
        const float move = length(moved.positions()[t.vertex_count + e] - smooth.positions()[t.vertex_count + e]);
        ASSERT_LE(move, 1.001F * pieces[edges.of_edge[e]].bounds.largest_move + 1e-6F);
        largest = std::max(largest, move);
      }
      const auto stated = [](const DetailPiece& piece) { return piece.bounds.largest_move; };
      EXPECT_GE(largest, 0.99F * stated(*std::ranges::max_element(pieces, {}, stated)) - 1e-6F);
    }
    EXPECT_GT(all.levels.back().pieces.size(), 2U);
  }
}

TEST(DetailPieces, PiecesThatDoNotMatchTheBytesAreRefused) {
  const DetailSource whole = test::detail_of_residuals(
      test::octahedron(), 1, 0.1F, [](int, uint32_t e, Vec3f) { return static_cast<int32_t>(e % 3); }, {4});
  const auto refused = [&](const auto& change) {
    DetailSource changed = whole;
    change(changed.levels[0]);
    try {
      (void)test::decoded_triangles(changed.base, changed.levels);
      return false;
    } catch (const Error& error) {
      return error.fault() == Fault::bad_option;
    }
  };
  EXPECT_FALSE(refused([](DetailStream&) {}));
  EXPECT_TRUE(refused([](DetailStream& level) { ++level.pieces[1].bytes; }));
  EXPECT_TRUE(refused([](DetailStream& level) { level.pieces[3].texcoord_bytes = 1; }));
  EXPECT_TRUE(refused([](DetailStream& level) { level.pieces[0].is_missing = true; }));
  EXPECT_TRUE(refused([](DetailStream& level) { level.pieces.resize(9); }));
  EXPECT_TRUE(refused([](DetailStream& level) { level.bytes.push_back(1); }));
}

TEST(DetailPieces, AnyBytesDecode) {
  std::mt19937 random(23);
  for (int round = 0; round < 100; ++round) {
    const TriangleMesh base = test::icosahedron();
    std::vector<DetailStream> levels(1 + random() % 3);
    for (DetailStream& level : levels) {
      level.step = 1e-3F;
      level.pieces.resize(1 + random() % 20);
      for (DetailPiece& piece : level.pieces) {
        piece.is_missing = random() % 5 == 0;
        piece.bytes = piece.is_missing ? 0 : random() % 30;
        for (uint32_t i = 0; i < piece.bytes; ++i) level.bytes.push_back(static_cast<uint8_t>(random()));
      }
    }
    EXPECT_EQ(test::decoded_triangles({base, {}}, levels).triangles.size(), 20U << (2 * levels.size()));
  }
}

}  // namespace
}  // namespace papilio
