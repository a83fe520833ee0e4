#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "detail/detail_level.h"
#include "detail/residual_models.h"
#include "papilio/buffer.h"

namespace papilio {

/// Residuals of the texture coordinates of a level's new vertices, in steps.
struct TexcoordResiduals {
  Buffer<int32_t> u, v;  ///< [E]

  friend bool operator==(const TexcoordResiduals&, const TexcoordResiduals&) = default;
};

/// Adaptive models of both coordinates. They go on from level to level, as do the residuals at vertices.
struct TexcoordModels {
  /// Of a base of so many vertices.
  explicit TexcoordModels(size_t vertices) : at_vertex{Buffer<int32_t>(vertices), Buffer<int32_t>(vertices)} {}
  /// Appends the residuals of a level's new vertices.
  void append(const TexcoordResiduals& residuals);

  std::unique_ptr<ResidualModels> u = std::make_unique<ResidualModels>(), v = std::make_unique<ResidualModels>();
  TexcoordResiduals at_vertex;  ///< [V]; 0 on the base
};

/// Codes the residuals of a level of a surface that is cut along its seams. `predicted` [V + E]: texture coordinates,
/// those of new vertices as predicted.
[[nodiscard]] std::vector<uint8_t> encode_texcoord_residuals(const DetailLevel& level,
                                                             const TexcoordResiduals& residuals, float step,
                                                             const Buffer<Vec3f>& predicted, TexcoordModels& models);
/// Decodes what encode_texcoord_residuals() made. Other bytes give other residuals within `largest_residual`.
[[nodiscard]] TexcoordResiduals decode_texcoord_residuals(const DetailLevel& level, std::span<const uint8_t> bytes,
                                                          float step, const Buffer<Vec3f>& predicted,
                                                          TexcoordModels& models);

}  // namespace papilio
