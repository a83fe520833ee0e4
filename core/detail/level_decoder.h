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
  /// Starts at a result of mesh_of_base(). `with_values`: whether to decode texture coordinates and colours.
  explicit LevelDecoder(const Mesh& base, bool with_values = false);

  /// Decodes the next level: positions [V] grow to [V + E]. Throws `Error` not_finite.
  void decode(const DetailStream& stream);

  /// Returns the vertices decoded so far.
  [[nodiscard]] const Buffer<Vec3f>& positions() const { return positions_; }
  /// Returns the texture coordinates and colours decoded so far; null if there are none.
  [[nodiscard]] const ValueLevels* values() const { return values_ ? &*values_ : nullptr; }
  /// Returns the finest decoded mesh, which decode() splits next. Valid until the next call of topology() after
  /// decode().
  [[nodiscard]] const Topology& topology();
  /// Returns the finest decoded mesh with edges, curves, and values if decoded; must be the last call.
  [[nodiscard]] Mesh take_mesh();

 private:
  PieceOrder order_;
  PieceNeeds needs_;
  Buffer<Vec3f> positions_;
  Buffer<int32_t> at_vertex_;  ///< [V] residuals along normals
  std::unique_ptr<ResidualModels> models_ = std::make_unique<ResidualModels>();
  std::optional<ValueLevels> values_;
  DetailLevel level_;
  bool is_split_ = false;  ///< whether `level_` is decoded; topology() then makes the next level on demand
};

}  // namespace papilio
