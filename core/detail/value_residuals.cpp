#include "detail/value_residuals.h"

namespace papilio {
namespace {

/// Pass over the residuals of a level, shared by encoder and decoder.
class ValuePass {
 public:
  ValuePass(const DetailLevel& level, const EdgePieces& pieces, std::span<const ValueChannel> channels,
            ValueResiduals& residuals, const ValueResiduals& at_vertex)
      : level_(level),
        pieces_(pieces),
        channels_(channels),
        residuals_(residuals),
        at_vertex_(at_vertex),
        coded_(channels.size(), Buffer<CodedResidual>(pieces.of_edge.size())) {}

  /// Codes the residuals of a piece in the order of their edges.
  template <class Code>
  void run(uint32_t piece, ValueModels& models, const Code& code) {
    for (const uint32_t e : pieces_.edges_of(piece))
      for (size_t c = 0; c < channels_.size(); ++c) {
        const ResidualContext context = level_.context(e, piece, coded_[c], at_vertex_[c],
                                                       channels_[c].predicted->data(), Vec3f{}, channels_[c].step);
        int32_t& residual = residuals_[c][e];
        residual = models[c].code(context, residual, code);
        coded_[c][e] = {.along_normal = residual, .piece = static_cast<uint16_t>(piece)};
      }
  }

 private:
  const DetailLevel& level_;
  const EdgePieces& pieces_;
  std::span<const ValueChannel> channels_;
  ValueResiduals& residuals_;
  const ValueResiduals& at_vertex_;
  std::vector<Buffer<CodedResidual>> coded_;  // [channel][E]
};

}  // namespace

std::vector<std::vector<uint8_t>> encode_value_residuals(const DetailLevel& level, const EdgePieces& pieces,
                                                         std::span<const ValueChannel> channels,
                                                         const ValueResiduals& residuals,
                                                         const ValueResiduals& at_vertex, ValueModels& models) {
  ValueResiduals copy = residuals;
  ValuePass pass(level, pieces, channels, copy, at_vertex);
  return encode_each_piece(pieces.count(), models,
                           [&](uint32_t piece, ValueModels& own, const auto& code) { pass.run(piece, own, code); });
}

ValueResiduals decode_value_residuals(const DetailLevel& level, const EdgePieces& pieces,
                                      std::span<const ValueChannel> channels, const PieceBytes& bytes,
                                      const ValueResiduals& at_vertex, ValueModels& models) {
  ValueResiduals residuals(channels.size(), Buffer<int32_t>(level.topology().edge_count()));
  ValuePass pass(level, pieces, channels, residuals, at_vertex);
  decode_each_piece(bytes, pieces.count(), models,
                    [&](uint32_t piece, ValueModels& own, const auto& code) { pass.run(piece, own, code); });
  return residuals;
}

}  // namespace papilio
