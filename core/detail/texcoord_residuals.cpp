#include "detail/texcoord_residuals.h"

#include "detail/binary_coder.h"

namespace papilio {
namespace {

/// What the residuals of a level are coded by.
struct TexcoordPass {
  const DetailLevel& level;
  const EdgePieces& pieces;
  TexcoordResiduals& residuals;
  float step;
  const TexcoordResiduals& at_vertex;
  const Buffer<Vec3f>& predicted;
  const Buffer<uint8_t> is_free{Buffer<uint8_t>(pieces.of_edge.size())};  ///< none is

  /// Goes through the residuals of a piece in the order of their edges and codes each: encoder and decoder alike.
  template <class Code>
  void run(uint32_t piece, TexcoordModels& models, const Code& code) {
    const auto code_one = [&](uint32_t e, ResidualModels& own, Buffer<int32_t>& of, const Buffer<int32_t>& at) {
      of[e] = own.code(level.context(e, {of, is_free, pieces.of_edge}, at, predicted.data(), step), of[e], code);
    };
    for (const uint32_t e : pieces.edges_of(piece)) {
      code_one(e, models.u, residuals.u, at_vertex.u);
      code_one(e, models.v, residuals.v, at_vertex.v);
    }
  }
};

}  // namespace

std::vector<std::vector<uint8_t>> encode_texcoord_residuals(const DetailLevel& level, const EdgePieces& pieces,
                                                            const TexcoordResiduals& residuals, float step,
                                                            const TexcoordResiduals& at_vertex,
                                                            const Buffer<Vec3f>& predicted, TexcoordModels& models) {
  TexcoordResiduals copy = residuals;
  TexcoordPass pass{level, pieces, copy, step, at_vertex, predicted};
  std::vector<std::vector<uint8_t>> made;
  code_pieces(pieces.count(), models, [&](uint32_t piece, TexcoordModels& own) {
    BinaryEncoder encoder;
    pass.run(piece, own, [&](bool bit, uint32_t probability) {
      encoder.code(bit, probability);
      return bit;
    });
    made.push_back(encoder.finish());
  });
  return made;
}

TexcoordResiduals decode_texcoord_residuals(const DetailLevel& level, const EdgePieces& pieces, const PieceBytes& bytes,
                                            float step, const TexcoordResiduals& at_vertex,
                                            const Buffer<Vec3f>& predicted, TexcoordModels& models) {
  const uint32_t edges = level.topology().edge_count();
  TexcoordResiduals residuals{.u = Buffer<int32_t>(edges), .v = Buffer<int32_t>(edges)};
  TexcoordPass pass{level, pieces, residuals, step, at_vertex, predicted};
  code_pieces(pieces.count(), models, [&](uint32_t piece, TexcoordModels& own) {
    if (!bytes[piece]) return;
    BinaryDecoder decoder(*bytes[piece]);
    pass.run(piece, own, [&](bool, uint32_t probability) { return decoder.code(probability); });
  });
  return residuals;
}

}  // namespace papilio
