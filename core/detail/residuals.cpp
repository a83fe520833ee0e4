#include "detail/residuals.h"

#include <algorithm>

#include "detail/binary_coder.h"
#include "detail/residual_frames.h"

namespace papilio {
namespace {

/// What the residuals of a level are coded by.
struct ResidualLevel {
  const DetailLevel& level;
  const EdgePieces& pieces;
  Residuals& residuals;
  std::span<const int32_t> at_vertex;
  const Buffer<Vec3f>& positions;
  Buffer<uint8_t> is_free{Buffer<uint8_t>(pieces.of_edge.size())};  ///< [E]
};

/// Goes through the residuals of a piece in the order of their edges and codes each: encoder and decoder alike.
template <class Code>
class ResidualPass {
 public:
  ResidualPass(ResidualLevel& of, ResidualModels& models, const Code& code)
      : level_(of.level),
        pieces_(of.pieces),
        residuals_(of.residuals),
        at_vertex_(of.at_vertex),
        positions_(of.positions),
        is_free_(of.is_free),
        models_(models),
        code_(code) {}

  void run(uint32_t piece) {
    const std::span<const uint32_t> edges = pieces_.edges_of(piece);
    if (edges.empty()) return;
    const std::span<const uint32_t> on_curves = level_.curve_edges();
    auto c = static_cast<uint32_t>(std::ranges::lower_bound(on_curves, edges.front()) - on_curves.begin());
    for (const uint32_t e : edges) {
      while (c < on_curves.size() && on_curves[c] < e) ++c;
      if (c < on_curves.size() && on_curves[c] == e)
        code_curve_edge(e, c);
      else
        code_edge(e);
    }
  }

 private:
  [[nodiscard]] bool has_tangential(uint32_t e) const { return residuals_.tangential.contains(e); }

  void code_edge(uint32_t e) {
    const ResidualContext context = level_.context(e, {residuals_.along_normal, is_free_, pieces_.of_edge}, at_vertex_,
                                                   positions_.data(), residuals_.step);
    is_free_[e] = models_.code_freedom(context, has_tangential(e), code_) ? 1 : 0;
    residuals_.along_normal[e] = models_.code(context, residuals_.along_normal[e], code_);
    if (is_free_[e] != 0) code_tangential(e);
  }

  void code_curve_edge(uint32_t e, uint32_t c) {
    const CurveContext context = level_.curve_context(c, residuals_.along_normal, residuals_.across, at_vertex_);
    is_free_[e] = models_.code_curve_freedom(context, has_tangential(e), code_) ? 1 : 0;
    int32_t& normal = residuals_.along_normal[e];
    normal = models_.code_curve_normal(context, normal, code_);
    if (is_free_[e] != 0)
      code_tangential(e);
    else
      residuals_.across[c] = models_.code_curve_across(context, normal, residuals_.across[c], code_);
  }

  void code_tangential(uint32_t e) {
    for (int32_t& part : residuals_.tangential[e]) part = models_.code_tangential(part, code_);
  }

  const DetailLevel& level_;
  const EdgePieces& pieces_;
  Residuals& residuals_;
  std::span<const int32_t> at_vertex_;
  const Buffer<Vec3f>& positions_;
  Buffer<uint8_t>& is_free_;  // [E]
  ResidualModels& models_;
  const Code& code_;
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

std::vector<std::vector<uint8_t>> encode_residuals(const DetailLevel& level, const EdgePieces& pieces,
                                                   const Residuals& residuals, std::span<const int32_t> at_vertex,
                                                   const Buffer<Vec3f>& positions, ResidualModels& models) {
  Residuals copy = residuals;
  ResidualLevel of{level, pieces, copy, at_vertex, positions};
  std::vector<std::vector<uint8_t>> made;
  code_pieces(pieces.count(), models, [&](uint32_t piece, ResidualModels& own) {
    BinaryEncoder encoder;
    const auto code = [&](bool bit, uint32_t probability) {
      encoder.code(bit, probability);
      return bit;
    };
    ResidualPass(of, own, code).run(piece);
    made.push_back(encoder.finish());
  });
  return made;
}

Residuals decode_residuals(const DetailLevel& level, const EdgePieces& pieces, const PieceBytes& bytes, float step,
                           std::span<const int32_t> at_vertex, const Buffer<Vec3f>& positions, ResidualModels& models) {
  Residuals residuals{.step = step,
                      .along_normal = Buffer<int32_t>(level.topology().edge_count()),
                      .across = Buffer<int32_t>(level.curve_edges().size())};
  ResidualLevel of{level, pieces, residuals, at_vertex, positions};
  code_pieces(pieces.count(), models, [&](uint32_t piece, ResidualModels& own) {
    if (!bytes[piece]) return;
    BinaryDecoder decoder(*bytes[piece]);
    const auto code = [&](bool, uint32_t probability) { return decoder.code(probability); };
    ResidualPass(of, own, code).run(piece);
  });
  return residuals;
}

}  // namespace papilio
