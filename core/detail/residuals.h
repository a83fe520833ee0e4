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

/// Residuals of one level in steps. Most new vertices move along their normals alone, those on curves also across their
/// edges. Free ones have two tangential parts in place of that.
struct Residuals {
  float step = 0;
  Buffer<int32_t> along_normal;                             ///< [E]
  Buffer<int32_t> across{};                                 ///< [C] of the edges on curves
  std::map<uint32_t, std::array<int32_t, 2>> tangential{};  ///< by edge: along the edge, and across it

  friend bool operator==(const Residuals&, const Residuals&) = default;
};

/// Moves the predicted new vertices of a level by their residuals. `positions` [V + E]; `normals` [E]. The same bits
/// everywhere.
void displace(const DetailLevel& level, const Buffer<Vec3f>& normals, const Residuals& residuals,
              Buffer<Vec3f>& positions);

/// Codes residuals, each piece by itself. `at_vertex` [V] are those of the vertices along their normals, 0 on the base;
/// `positions` [V + E] hold the predictions. `models` learn, and go on to the next level.
[[nodiscard]] std::vector<std::vector<uint8_t>> encode_residuals(const DetailLevel& level, const EdgePieces& pieces,
                                                                 const Residuals& residuals,
                                                                 std::span<const int32_t> at_vertex,
                                                                 const Buffer<Vec3f>& positions,
                                                                 ResidualModels& models);
/// Decodes what encode_residuals() made. Other bytes give other residuals within `largest_residual`.
[[nodiscard]] Residuals decode_residuals(const DetailLevel& level, const EdgePieces& pieces, const PieceBytes& bytes,
                                         float step, std::span<const int32_t> at_vertex, const Buffer<Vec3f>& positions,
                                         ResidualModels& models);

}  // namespace papilio
