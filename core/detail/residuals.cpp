#include "detail/residuals.h"

#include "detail/binary_coder.h"
#include "detail/residual_frames.h"

namespace papilio {
namespace {

/// Goes through the residuals in the order of their edges and codes each: encoder and decoder alike.
template <class Code>
void code_residuals(const DetailLevel& level, Residuals& residuals, std::span<const int32_t> at_vertex,
                    const Buffer<Vec3f>& positions, ResidualModels& models, const Code& code) {
  Buffer<uint8_t> is_free(residuals.along_normal.size());
  for (uint32_t e = 0; e < residuals.along_normal.size(); ++e) {
    const ResidualContext context =
        level.context(e, residuals.along_normal, is_free, at_vertex, positions.data(), residuals.step);
    const auto found = residuals.tangential.find(e);
    is_free[e] = models.code_freedom(context, found != residuals.tangential.end(), code) ? 1 : 0;
    residuals.along_normal[e] = models.code(context, residuals.along_normal[e], code);
    if (is_free[e] == 0) continue;
    auto& parts = residuals.tangential[e];
    for (int32_t& part : parts) part = models.code_tangential(part, code);
  }
}

}  // namespace

Vec3f displacement(const DetailLevel& level, const Buffer<Vec3f>& normals, const Residuals& residuals,
                   const Buffer<Vec3f>& positions, uint32_t e) {
  Vec3f move = (static_cast<float>(residuals.along_normal[e]) * residuals.step) * normals[e];
  const auto found = residuals.tangential.find(e);
  if (found == residuals.tangential.end()) return move;
  const Tangents tangents = residual_tangents(level.topology(), positions.data(), e, normals[e]);
  move += (static_cast<float>(found->second[0]) * residuals.step) * tangents.along;
  move += (static_cast<float>(found->second[1]) * residuals.step) * tangents.across;
  return move;
}

void displace(const DetailLevel& level, const Buffer<Vec3f>& normals, const Residuals& residuals,
              Buffer<Vec3f>& positions) {
  const uint32_t vertices = level.topology().vertex_count;
  auto next = residuals.tangential.begin();
  for (uint32_t e = 0; e < level.topology().edge_count(); ++e) {
    if (next == residuals.tangential.end() || next->first != e) {
      positions[vertices + e] += (static_cast<float>(residuals.along_normal[e]) * residuals.step) * normals[e];
      continue;
    }
    positions[vertices + e] += displacement(level, normals, residuals, positions, e);
    ++next;
  }
}

std::vector<uint8_t> encode_residuals(const DetailLevel& level, const Residuals& residuals,
                                      std::span<const int32_t> at_vertex, const Buffer<Vec3f>& positions,
                                      ResidualModels& models) {
  BinaryEncoder encoder;
  Residuals copy = residuals;
  code_residuals(level, copy, at_vertex, positions, models, [&](bool bit, uint32_t probability) {
    encoder.code(bit, probability);
    return bit;
  });
  return encoder.finish();
}

Residuals decode_residuals(const DetailLevel& level, std::span<const uint8_t> bytes, float step,
                           std::span<const int32_t> at_vertex, const Buffer<Vec3f>& positions, ResidualModels& models) {
  BinaryDecoder decoder(bytes);
  Residuals residuals{.step = step, .along_normal = Buffer<int32_t>(level.topology().edge_count())};
  code_residuals(level, residuals, at_vertex, positions, models,
                 [&](bool, uint32_t probability) { return decoder.code(probability); });
  return residuals;
}

}  // namespace papilio
