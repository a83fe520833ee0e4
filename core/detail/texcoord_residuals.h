#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "detail/detail_level.h"
#include "detail/pieces.h"
#include "detail/residual_models.h"
#include "papilio/buffer.h"

namespace papilio {

/// Residuals of the texture coordinates of a level's new vertices, in steps.
struct TexcoordResiduals {
  Buffer<int32_t> u, v;  ///< [E]

  friend bool operator==(const TexcoordResiduals&, const TexcoordResiduals&) = default;
};

/// Adaptive models of both coordinates, which go on from level to level.
struct TexcoordModels {
  ResidualModels u, v;
};

/// Codes the residuals of a level of a surface that is cut along its seams, each piece by itself. `at_vertex` [V] are
/// those of the vertices, 0 on the base; `predicted` [V + E]: texture coordinates, those of new vertices as predicted.
[[nodiscard]] std::vector<std::vector<uint8_t>> encode_texcoord_residuals(
    const DetailLevel& level, const EdgePieces& pieces, const TexcoordResiduals& residuals, float step,
    const TexcoordResiduals& at_vertex, const Buffer<Vec3f>& predicted, TexcoordModels& models);
/// Decodes what encode_texcoord_residuals() made. Other bytes give other residuals within `largest_residual`.
[[nodiscard]] TexcoordResiduals decode_texcoord_residuals(const DetailLevel& level, const EdgePieces& pieces,
                                                          const PieceBytes& bytes, float step,
                                                          const TexcoordResiduals& at_vertex,
                                                          const Buffer<Vec3f>& predicted, TexcoordModels& models);

}  // namespace papilio
