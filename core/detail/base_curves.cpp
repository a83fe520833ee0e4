#include "detail/base_curves.h"

#include <algorithm>
#include <array>

#include "detail/binary_coder.h"
#include "detail/mixed_bit.h"
#include "mesh/crease.h"
#include "mesh/curve.h"

namespace papilio {
namespace {

/// Codes the edges, then the vertices, in encoder and decoder. code(bit, probability) encodes the bit, or ignores it
/// and decodes one; it returns the bit.
template <class Code>
void code_curves(Topology& base, const Code& code) {
  constexpr uint8_t many = 2;
  std::vector<uint8_t> creases(base.vertex_count, 0);  // [V] creases coded so far, at most `many`
  std::array<BitModel, 9> crease_models{};
  BitModel corner_model;
  const auto code_by = [&](BitModel& model, bool bit) {
    const bool coded = code(bit, model.probability());
    model.update(coded);
    return coded;
  };
  for (uint32_t e = 0; e < base.edge_count(); ++e) {
    if (base.kind[e] == EdgeKind::boundary) continue;
    const uint32_t h = base.half_edge[e];
    uint8_t& at_origin = creases[base.origin[h]];
    uint8_t& at_tip = creases[base.tip(h)];
    const auto [less, more] = std::minmax(at_origin, at_tip);
    const bool is_crease = code_by(crease_models[size_t{3} * less + more], base.kind[e] == EdgeKind::crease);
    base.kind[e] = is_crease ? EdgeKind::crease : EdgeKind::smooth;
    if (!is_crease) continue;
    for (uint8_t* count : {&at_origin, &at_tip}) *count = std::min<uint8_t>(*count + 1, many);
  }
  const VertexDegrees curves(base, [&](uint32_t e) { return base.kind[e] != EdgeKind::smooth; });
  std::vector<uint32_t> corners;
  for (uint32_t v = 0; v < base.vertex_count; ++v)
    if (curves.degree[v] == 2 && code_by(corner_model, std::ranges::binary_search(base.shape.corners, v)))
      corners.push_back(v);
  base.shape.corners = std::move(corners);
  base.darts = find_darts(base);
}

}  // namespace

std::vector<uint8_t> encode_base_curves(const Topology& base) {
  if (base.shape.corners.empty() && std::ranges::count(base.kind, EdgeKind::crease) == 0) return {};
  Topology copy = base;
  BinaryEncoder encoder;
  code_curves(copy, [&](bool bit, uint32_t probability) { return encoder.code(bit, probability); });
  std::vector<uint8_t> bytes = encoder.finish();
  if (bytes.empty()) bytes.push_back(0);  // the coder drops trailing zeros, but no bytes mean no curves
  return bytes;
}

void decode_base_curves(std::span<const uint8_t> bytes, Topology& base) {
  if (bytes.empty()) return;
  BinaryDecoder decoder(bytes);
  code_curves(base, [&](bool, uint32_t probability) { return decoder.code(probability); });
}

}  // namespace papilio
