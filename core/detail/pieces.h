#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "detail/binary_coder.h"
#include "papilio/detail.h"
#include "papilio/mesh.h"

// Pieces of a level: independently coded edges below neighbouring faces of the base.

namespace papilio {

/// Edges of a level by piece.
struct EdgePieces {
  Buffer<uint16_t> of_edge;  ///< [E] number of the piece
  Buffer<uint32_t> edges;    ///< [E] edges by piece, then in ascending order
  Buffer<uint32_t> begin;    ///< [pieces + 1] offsets into `edges`

  [[nodiscard]] uint32_t count() const { return static_cast<uint32_t>(begin.size()) - 1; }
  [[nodiscard]] std::span<const uint32_t> edges_of(uint32_t piece) const {
    return {edges.data() + begin[piece], begin[piece + 1] - begin[piece]};
  }
  /// Returns the pieces of the surface cut along seams: a cut edge keeps its piece.
  [[nodiscard]] EdgePieces on_cut(const Topology& whole, const Topology& cut) const;
};

/// Bytes of a level's pieces; nothing for a piece that is not decoded, whose residuals are 0.
using PieceBytes = std::vector<std::optional<std::span<const uint8_t>>>;

/// Order of a base's faces along a space-filling curve, which divides them into pieces.
class PieceOrder {
 public:
  explicit PieceOrder(const Mesh& base);

  /// Returns the piece of a face of the base, out of `count` pieces.
  [[nodiscard]] uint32_t piece_of(uint32_t face, uint32_t count) const {
    return static_cast<uint32_t>(uint64_t{rank_[face]} * count / rank_.size());
  }
  /// Returns the edges that level `number` (0: the base) splits, by piece: an edge belongs to the base's face of its
  /// half-edge.
  [[nodiscard]] EdgePieces edges(const Topology& level, uint32_t number, uint32_t count) const;
  /// Returns [3F] the corners of the base's faces.
  [[nodiscard]] std::span<const uint32_t> corners() const { return {corners_.data(), corners_.size()}; }

 private:
  Buffer<uint32_t> rank_;  // [F of the base] place in the order
  Buffer<uint32_t> corners_;
};

/// Dependencies of pieces, level by level: which ones can be decoded if some are missing. A piece depends on the pieces
/// of the level before at all vertices of its faces of the base. It also depends on the first piece of its level, with
/// whose models it starts; that one depends on the first piece of the level before.
class PieceNeeds {
 public:
  /// Starts at a base of `vertices` vertices.
  explicit PieceNeeds(uint32_t vertices) : is_known_(vertices, 1) {}
  /// Advances to the next level, and returns [pieces] whether each can be decoded.
  [[nodiscard]] std::vector<uint8_t> next(const PieceOrder& order, std::span<const DetailPiece> pieces);

 private:
  Buffer<uint8_t> is_known_;     // [V of the base] whether all pieces at the vertex were decoded
  bool has_first_piece_ = true;  // whether the first piece of each level so far was decoded
};

/// Returns the pieces of a stream; one of all its bytes if it has none.
[[nodiscard]] std::vector<DetailPiece> pieces_of(const DetailStream& stream);
/// Returns the bytes of each piece that can be decoded. `all` are the residuals or the texture coordinates of a level,
/// and `size` the field of a piece's length in them.
[[nodiscard]] PieceBytes piece_bytes(std::span<const uint8_t> all, std::span<const DetailPiece> pieces,
                                     uint32_t DetailPiece::*size, std::span<const uint8_t> is_decoded);

/// Calls code(piece, models) for all pieces. The first one updates `models`, for the next level too; each other piece
/// starts with a copy of them.
template <class Models, class Code>
void code_pieces(uint32_t count, Models& models, const Code& code) {
  code(0, models);
  for (uint32_t p = 1; p < count; ++p) {
    Models own(models);
    code(p, own);
  }
}

/// Encodes all pieces: pass(piece, models, code) codes the bits of one through `code`, as in ResidualModels.
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
