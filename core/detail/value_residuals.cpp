#include "detail/value_residuals.h"

namespace papilio {
namespace {

/// Pass over the residuals of a level, shared by encoder and decoder.
struct ValuePass {
  const DetailLevel& level;
  const EdgePieces& pieces;
  std::span<const ValueChannel> channels;
  ValueResiduals& residuals;
  const ValueResiduals& at_vertex;
  const Buffer<uint8_t> is_free{Buffer<uint8_t>(pieces.of_edge.size())};  ///< all 0: no residual is free

  /// Codes the residuals of a piece in the order of their edges.
  template <class Code>
  void run(uint32_t piece, ValueModels& models, const Code& code) {
    for (const uint32_t e : pieces.edges_of(piece))
      for (size_t c = 0; c < channels.size(); ++c) {
        Buffer<int32_t>& of = residuals[c];
        of[e] = models[c].code(level.context(e, {of, is_free, pieces.of_edge}, at_vertex[c],
                                             channels[c].predicted->data(), Vec3f{}, channels[c].step),
                               of[e], code);
      }
  }
};

}  // namespace

std::vector<std::vector<uint8_t>> encode_value_residuals(const DetailLevel& level, const EdgePieces& pieces,
                                                         std::span<const ValueChannel> channels,
                                                         const ValueResiduals& residuals,
                                                         const ValueResiduals& at_vertex, ValueModels& models) {
  ValueResiduals copy = residuals;
  ValuePass pass{level, pieces, channels, copy, at_vertex};
  return encode_each_piece(pieces.count(), models,
                           [&](uint32_t piece, ValueModels& own, const auto& code) { pass.run(piece, own, code); });
}

ValueResiduals decode_value_residuals(const DetailLevel& level, const EdgePieces& pieces,
                                      std::span<const ValueChannel> channels, const PieceBytes& bytes,
                                      const ValueResiduals& at_vertex, ValueModels& models) {
  ValueResiduals residuals(channels.size(), Buffer<int32_t>(level.topology().edge_count()));
  ValuePass pass{level, pieces, channels, residuals, at_vertex};
  decode_each_piece(bytes, pieces.count(), models,
                    [&](uint32_t piece, ValueModels& own, const auto& code) { pass.run(piece, own, code); });
  return residuals;
}

}  // namespace papilio
