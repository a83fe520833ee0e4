#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "detail/detail_level.h"
#include "detail/pieces.h"
#include "detail/value_levels.h"
#include "papilio/detail.h"

namespace papilio {

/// Builds the mesh of a base, with its curves. Throws `Error` bad_surface unless it is manifold, and bad_option for
/// attributes that levels do not carry.
[[nodiscard]] Mesh mesh_of_base(const DetailBase& base);

/// Decoder of a base's levels, coarse first.
class LevelDecoder {
 public:
  /// Takes what mesh_of_base() returns. Texture coordinates and colours are decoded if asked.
  explicit LevelDecoder(const Mesh& base, bool with_values = false);

  /// Decodes the next level: positions [V] grow to [V + E]. Throws `Error` not_finite.
  void decode(const DetailStream& stream);

  /// Vertices decoded so far.
  [[nodiscard]] const Buffer<Vec3f>& positions() const { return positions_; }
  /// Texture coordinates and colours of what was decoded; null where none are.
  [[nodiscard]] const ValueLevels* values() const { return values_ ? &*values_ : nullptr; }
  /// The finest mesh decoded, which `decode` splits next. Stays as it is until the next call after that.
  [[nodiscard]] const Topology& topology();
  /// Returns the finest mesh decoded, with its edges and curves, and with the values if they are; call last.
  [[nodiscard]] Mesh take_mesh();

 private:
  PieceOrder order_;
  PieceNeeds needs_;
  Buffer<Vec3f> positions_;
  Buffer<int32_t> at_vertex_;  ///< [V] residuals along normals
  std::unique_ptr<ResidualModels> models_ = std::make_unique<ResidualModels>();
  std::optional<ValueLevels> values_;
  DetailLevel level_;
  bool is_split_ = false;  ///< whether `level_` is decoded: connectivity below it is made when it is needed
};

}  // namespace papilio
