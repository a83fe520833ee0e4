#include "detail/texcoord_residuals.h"

#include "detail/binary_coder.h"

namespace papilio {
namespace {

/// Goes through the residuals in the order of their edges and codes each: encoder and decoder alike.
template <class Code>
void code_texcoords(const DetailLevel& level, TexcoordResiduals& residuals, float step, const Buffer<Vec3f>& predicted,
                    TexcoordModels& models, const Code& code) {
  const Buffer<uint8_t> is_free(level.topology().edge_count());  // none is
  const auto code_one = [&](uint32_t e, ResidualModels& own, Buffer<int32_t>& of, const Buffer<int32_t>& at_vertex) {
    of[e] = own.code(level.context(e, of, is_free, at_vertex, predicted.data(), step), of[e], code);
  };
  for (uint32_t e = 0; e < level.topology().edge_count(); ++e) {
    code_one(e, *models.u, residuals.u, models.at_vertex.u);
    code_one(e, *models.v, residuals.v, models.at_vertex.v);
  }
}

}  // namespace

void TexcoordModels::append(const TexcoordResiduals& residuals) {
  at_vertex.u.insert(at_vertex.u.end(), residuals.u.begin(), residuals.u.end());
  at_vertex.v.insert(at_vertex.v.end(), residuals.v.begin(), residuals.v.end());
}

std::vector<uint8_t> encode_texcoord_residuals(const DetailLevel& level, const TexcoordResiduals& residuals, float step,
                                               const Buffer<Vec3f>& predicted, TexcoordModels& models) {
  BinaryEncoder encoder;
  TexcoordResiduals copy = residuals;
  const auto code = [&](bool bit, uint32_t probability) {
    encoder.code(bit, probability);
    return bit;
  };
  code_texcoords(level, copy, step, predicted, models, code);
  return encoder.finish();
}

TexcoordResiduals decode_texcoord_residuals(const DetailLevel& level, std::span<const uint8_t> bytes, float step,
                                            const Buffer<Vec3f>& predicted, TexcoordModels& models) {
  BinaryDecoder decoder(bytes);
  const uint32_t edges = level.topology().edge_count();
  TexcoordResiduals residuals{.u = Buffer<int32_t>(edges), .v = Buffer<int32_t>(edges)};
  const auto code = [&](bool, uint32_t probability) { return decoder.code(probability); };
  code_texcoords(level, residuals, step, predicted, models, code);
  return residuals;
}

}  // namespace papilio
