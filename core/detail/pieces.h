#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "detail/binary_coder.h"
#include "papilio/detail.h"
#include "papilio/mesh.h"

// Pieces of a level: the edges below some faces of the base that lie together, coded by themselves.

namespace papilio {

/// Edges of a level by piece.
struct EdgePieces {
  Buffer<uint16_t> of_edge;  ///< [E] number of the piece
  Buffer<uint32_t> edges;    ///< [E] piece by piece, in each in ascending order
  Buffer<uint32_t> begin;    ///< [pieces + 1] into `edges`

  [[nodiscard]] uint32_t count() const { return static_cast<uint32_t>(begin.size()) - 1; }
  [[nodiscard]] std::span<const uint32_t> edges_of(uint32_t piece) const {
    return {edges.data() + begin[piece], begin[piece + 1] - begin[piece]};
  }
  /// The pieces of the same surface when it is cut along seams: an edge's are those of the edge that it was.
  [[nodiscard]] EdgePieces on_cut(const Topology& whole, const Topology& cut) const;
};

/// Bytes of a level's pieces; nothing: that piece is not decoded, and its residuals are 0.
using PieceBytes = std::vector<std::optional<std::span<const uint8_t>>>;

/// Faces of a base in the order that parts them into pieces: along a space-filling curve.
class PieceOrder {
 public:
  explicit PieceOrder(const Mesh& base);

  /// The piece of a face of the base where there are `count` of them.
  [[nodiscard]] uint32_t piece_of(uint32_t face, uint32_t count) const {
    return static_cast<uint32_t>(uint64_t{rank_[face]} * count / rank_.size());
  }
  /// The edges that a level of this number (0: the base) splits. An edge is of the face that its half-edge is below.
  [[nodiscard]] EdgePieces edges(const Topology& level, uint32_t number, uint32_t count) const;
  /// [3 F] the corners of the base's faces.
  [[nodiscard]] std::span<const uint32_t> corners() const { return {corners_.data(), corners_.size()}; }

 private:
  Buffer<uint32_t> rank_;  // [F] of the base
  Buffer<uint32_t> corners_;
};

/// Tells which pieces can be decoded where some are missing, level by level. A piece needs those of the level before of
/// all faces of the base that share a vertex with one of its own, and the first of its level, whose models it starts
/// with; that one needs the first of the level before.
class PieceNeeds {
 public:
  /// Of a base of so many vertices.
  explicit PieceNeeds(uint32_t vertices) : is_known_(vertices, 1) {}
  /// Returns [pieces] of the next level whether each can be decoded.
  [[nodiscard]] std::vector<uint8_t> next(const PieceOrder& order, std::span<const DetailPiece> pieces);

 private:
  Buffer<uint8_t> is_known_;     // [V] of the base: whether all was decoded below the faces there
  bool has_first_piece_ = true;  // of the level before
};

/// The pieces of a stream: where it has none, one of all its bytes.
[[nodiscard]] std::vector<DetailPiece> pieces_of(const DetailStream& stream);
/// The bytes of each of them, of residuals or of texture coordinates, if it can be decoded.
[[nodiscard]] PieceBytes piece_bytes(std::span<const uint8_t> all, std::span<const DetailPiece> pieces,
                                     uint32_t DetailPiece::*size, std::span<const uint8_t> is_decoded);

/// Calls code(piece, models) for all pieces. The first one goes on with the models, which go on to the next level; each
/// other starts with those at its end.
template <class Models, class Code>
void code_pieces(uint32_t count, Models& models, const Code& code) {
  code(0, models);
  for (uint32_t p = 1; p < count; ++p) {
    Models own(models);
    code(p, own);
  }
}

/// Encodes all pieces: pass(piece, models, code) goes through the bits of one, as ResidualModels has it.
template <class Models, class Pass>
[[nodiscard]] std::vector<std::vector<uint8_t>> encode_each_piece(uint32_t count, Models& models, const Pass& pass) {
  std::vector<std::vector<uint8_t>> made;
  code_pieces(count, models, [&](uint32_t piece, Models& own) {
    BinaryEncoder encoder;
    pass(piece, own, [&](bool bit, uint32_t probability) { return encoder.code(bit, probability); });
    made.push_back(encoder.finish());
  });
  return made;
}
/// Decodes the pieces that have bytes.
template <class Models, class Pass>
void decode_each_piece(const PieceBytes& bytes, uint32_t count, Models& models, const Pass& pass) {
  code_pieces(count, models, [&](uint32_t piece, Models& own) {
    if (!bytes[piece]) return;
    BinaryDecoder decoder(*bytes[piece]);
    pass(piece, own, [&](bool, uint32_t probability) { return decoder.code(probability); });
  });
}

}  // namespace papilio
