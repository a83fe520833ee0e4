#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "detail/detail_level.h"
#include "detail/pieces.h"
#include "detail/residual_models.h"
#include "papilio/mesh.h"

namespace papilio {

/// Residuals of one level, in steps. Most new vertices move along their normals only; those on curves also across their
/// edges. Free residuals have two tangential parts instead of the latter.
struct Residuals {
  float step = 0;
  Buffer<int32_t> along_normal;                             ///< [E] parts along normals
  Buffer<int32_t> across{};                                 ///< [C] parts across edges on curves
  std::map<uint32_t, std::array<int32_t, 2>> tangential{};  ///< parts along and across the edge, by edge

  friend bool operator==(const Residuals&, const Residuals&) = default;
};

/// Moves the predicted new vertices of a level by their residuals. Bit-identical on every processor. `positions` [V +
/// E], `normals` [E]
void displace(const DetailLevel& level, const Buffer<Vec3f>& normals, const Residuals& residuals,
              Buffer<Vec3f>& positions);

/// What encoder and decoder know of a level before its residuals. The arrays must outlive this object.
struct PredictedLevel {
  const DetailLevel& level;
  const EdgePieces& pieces;
  std::span<const int32_t> at_vertex;  ///< [V] residuals of the vertices along normals, 0 on the base
  const Buffer<Vec3f>& positions;      ///< [V + E], predictions included
  const Buffer<Vec3f>& normals;        ///< [E] directions of residuals (residual_frames.h)
};

/// Encodes residuals, each piece independently. Adapts `models`, for the next level too.
[[nodiscard]] std::vector<std::vector<uint8_t>> encode_residuals(const PredictedLevel& predicted,
                                                                 const Residuals& residuals, ResidualModels& models);
/// Decodes the bytes of encode_residuals(). Any other bytes are decoded to residuals within `largest_residual`.
[[nodiscard]] Residuals decode_residuals(const PredictedLevel& predicted, const PieceBytes& bytes, float step,
                                         ResidualModels& models);

}  // namespace papilio
