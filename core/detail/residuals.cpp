#include "detail/residuals.h"

#include <algorithm>

#include "detail/residual_frames.h"

namespace papilio {
namespace {

/// Pass over the residuals of a level, shared by encoder and decoder.
class ResidualPass {
 public:
  ResidualPass(const PredictedLevel& predicted, Residuals& residuals)
      : predicted_(predicted), residuals_(residuals), coded_(predicted.pieces.of_edge.size()) {
    for (const auto& [e, parts] : residuals.tangential) coded_[e].is_free = true;
  }

  /// Codes the residuals of a piece in the order of their edges.
  template <class Code>
  void run(uint32_t piece, ResidualModels& models, const Code& code) {
    const std::span<const uint32_t> edges = predicted_.pieces.edges_of(piece);
    if (edges.empty()) return;
    const std::span<const uint32_t> on_curves = predicted_.level.curve_edges();
    auto c = static_cast<uint32_t>(std::ranges::lower_bound(on_curves, edges.front()) - on_curves.begin());
    for (const uint32_t e : edges) {
      while (c < on_curves.size() && on_curves[c] < e) ++c;
      if (c < on_curves.size() && on_curves[c] == e)
        code_curve_edge(e, c, models, code);
      else
        code_edge(e, piece, models, code);
      coded_[e].along_normal = residuals_.along_normal[e];
      coded_[e].piece = static_cast<uint16_t>(piece);
    }
  }

 private:
  template <class Code>
  void code_edge(uint32_t e, uint32_t piece, ResidualModels& models, const Code& code) {
    const auto& [level, pieces, at_vertex, positions, normals] = predicted_;
    const ResidualContext context =
        level.context(e, piece, coded_, at_vertex, positions.data(), normals[e], residuals_.step);
    coded_[e].is_free = models.code_freedom(context, coded_[e].is_free, code);
    residuals_.along_normal[e] = models.code(context, residuals_.along_normal[e], code);
    if (coded_[e].is_free) code_tangential(e, models, code);
  }

  template <class Code>
  void code_curve_edge(uint32_t e, uint32_t c, ResidualModels& models, const Code& code) {
    const CurveContext context =
        predicted_.level.curve_context(c, residuals_.along_normal, residuals_.across, predicted_.at_vertex);
    coded_[e].is_free = models.code_curve_freedom(context, coded_[e].is_free, code);
    int32_t& normal = residuals_.along_normal[e];
    normal = models.code_curve_normal(context, normal, code);
    if (coded_[e].is_free)
      code_tangential(e, models, code);
    else
      residuals_.across[c] = models.code_curve_across(context, normal, residuals_.across[c], code);
  }

  template <class Code>
  void code_tangential(uint32_t e, ResidualModels& models, const Code& code) {
    for (int32_t& part : residuals_.tangential[e]) part = models.code_tangential(part, code);
  }

  const PredictedLevel& predicted_;
  Residuals& residuals_;
  Buffer<CodedResidual> coded_;  // [E]
};

}  // namespace

void displace(const DetailLevel& level, const Buffer<Vec3f>& normals, const Residuals& residuals,
              Buffer<Vec3f>& positions) {
  const Topology& mesh = level.topology();
  const float step = residuals.step;
  for (uint32_t e = 0; e < mesh.edge_count(); ++e)
    positions[mesh.vertex_count + e] += (static_cast<float>(residuals.along_normal[e]) * step) * normals[e];
  for (size_t c = 0; c < residuals.across.size(); ++c) {
    if (residuals.across[c] == 0) continue;
    const uint32_t e = level.curve_edges()[c];
    const Tangents tangents = residual_tangents(mesh, positions.data(), e, normals[e]);
    positions[mesh.vertex_count + e] += (static_cast<float>(residuals.across[c]) * step) * tangents.across;
  }
  for (const auto& [e, parts] : residuals.tangential) {
    const Tangents tangents = residual_tangents(mesh, positions.data(), e, normals[e]);
    positions[mesh.vertex_count + e] += (static_cast<float>(parts[0]) * step) * tangents.along;
    positions[mesh.vertex_count + e] += (static_cast<float>(parts[1]) * step) * tangents.across;
  }
}

std::vector<std::vector<uint8_t>> encode_residuals(const PredictedLevel& predicted, const Residuals& residuals,
                                                   ResidualModels& models) {
  Residuals copy = residuals;
  ResidualPass pass(predicted, copy);
  return encode_each_piece(predicted.pieces.count(), models,
                           [&](uint32_t piece, ResidualModels& own, const auto& code) { pass.run(piece, own, code); });
}

Residuals decode_residuals(const PredictedLevel& predicted, const PieceBytes& bytes, float step,
                           ResidualModels& models) {
  Residuals residuals{.step = step,
                      .along_normal = Buffer<int32_t>(predicted.level.topology().edge_count()),
                      .across = Buffer<int32_t>(predicted.level.curve_edges().size())};
  ResidualPass pass(predicted, residuals);
  decode_each_piece(bytes, predicted.pieces.count(), models,
                    [&](uint32_t piece, ResidualModels& own, const auto& code) { pass.run(piece, own, code); });
  return residuals;
}

}  // namespace papilio
