#include "detail/residuals.h"

#include "detail/binary_coder.h"
#include "detail/residual_frames.h"

namespace papilio {
namespace {

/// Goes through the residuals in the order of their edges and codes each: encoder and decoder alike.
template <class Code>
class ResidualPass {
 public:
  ResidualPass(const DetailLevel& level, Residuals& residuals, std::span<const int32_t> at_vertex,
               const Buffer<Vec3f>& positions, ResidualModels& models, const Code& code)
      : level_(level),
        residuals_(residuals),
        at_vertex_(at_vertex),
        positions_(positions),
        models_(models),
        code_(code),
        is_free_(residuals.along_normal.size()) {}

  void run() {
    const std::span<const uint32_t> curve_edges = level_.curve_edges();
    uint32_t c = 0;
    for (uint32_t e = 0; e < is_free_.size(); ++e) {
      if (c < curve_edges.size() && curve_edges[c] == e)
        code_curve_edge(e, c++);
      else
        code_edge(e);
    }
  }

 private:
  [[nodiscard]] bool has_tangential(uint32_t e) const { return residuals_.tangential.contains(e); }

  void code_edge(uint32_t e) {
    const ResidualContext context =
        level_.context(e, residuals_.along_normal, is_free_, at_vertex_, positions_.data(), residuals_.step);
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
  Residuals& residuals_;
  std::span<const int32_t> at_vertex_;
  const Buffer<Vec3f>& positions_;
  ResidualModels& models_;
  const Code& code_;
  Buffer<uint8_t> is_free_;  // [E]
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

std::vector<uint8_t> encode_residuals(const DetailLevel& level, const Residuals& residuals,
                                      std::span<const int32_t> at_vertex, const Buffer<Vec3f>& positions,
                                      ResidualModels& models) {
  BinaryEncoder encoder;
  Residuals copy = residuals;
  const auto code = [&](bool bit, uint32_t probability) {
    encoder.code(bit, probability);
    return bit;
  };
  ResidualPass(level, copy, at_vertex, positions, models, code).run();
  return encoder.finish();
}

Residuals decode_residuals(const DetailLevel& level, std::span<const uint8_t> bytes, float step,
                           std::span<const int32_t> at_vertex, const Buffer<Vec3f>& positions, ResidualModels& models) {
  BinaryDecoder decoder(bytes);
  Residuals residuals{.step = step,
                      .along_normal = Buffer<int32_t>(level.topology().edge_count()),
                      .across = Buffer<int32_t>(level.curve_edges().size())};
  const auto code = [&](bool, uint32_t probability) { return decoder.code(probability); };
  ResidualPass(level, residuals, at_vertex, positions, models, code).run();
  return residuals;
}

}  // namespace papilio
