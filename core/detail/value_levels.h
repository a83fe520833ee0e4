#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "detail/detail_level.h"
#include "detail/value_residuals.h"
#include "papilio/detail.h"
#include "papilio/mesh.h"

namespace papilio {

/// Texture coordinates and colours of a base's levels, on the surface cut along its seams. Decoder and encoder share
/// it. Each level predicts the values of its new vertices by the rules of positions within the charts, corrects them by
/// the actual positions, and adds residuals.
class ValueLevels {
 public:
  /// Values of one attribute.
  struct Track {
    uint32_t components = 0;  ///< 2 or 3
    /// Values [V], or [V + E] of a predicted level; the third component of texture coordinates is 0.
    Buffer<Vec3f> values{};
  };

  /// Starts at a base with values (base_attributes.h), cut along `seams`. Throws `Error` not_finite.
  ValueLevels(const Mesh& base, const std::vector<uint32_t>& seams);

  /// Predicts the values of a level's new vertices. `whole` is the level before it is cut; `positions`, at least [V +
  /// E], are its vertices with the new ones.
  void predict(const Topology& whole, const Buffer<Vec3f>& positions);
  /// Decodes the residuals of the predicted level, and advances to the next one. `pieces`: pieces of its edges. `step`
  /// 0: all residuals are 0. Throws `Error` not_finite.
  void decode(const EdgePieces& pieces, const PieceBytes& bytes, float step);
  /// Encodes the predicted level, and advances to the next one. Its values are within 3/4 of a step of `wanted`
  /// [track][E]. Returns the bytes of its pieces; none if all residuals are 0.
  [[nodiscard]] std::vector<std::vector<uint8_t>> encode(const EdgePieces& pieces,
                                                         std::span<const Buffer<Vec3f>> wanted, float step);

  /// Returns the cut level that predict() predicts. Valid until the next call of level() after decode() or encode().
  [[nodiscard]] const DetailLevel& level();
  /// Returns the attributes, in the order of the base's.
  [[nodiscard]] const std::vector<Track>& tracks() const { return tracks_; }
  /// Returns the uncut surface's vertex at each cut one [V], or [V + E] of a predicted level.
  [[nodiscard]] const Buffer<uint32_t>& vertices() const { return vertices_; }
  /// Returns [H] the values at the new points on the half-edges of the last decoded level, of the track with
  /// `Components` components; empty if there is none. Must be called before level().
  template <size_t Components>
  [[nodiscard]] Buffer<std::array<float, Components>> on_half_edges() const;
  /// Returns the points of all levels so far, several at vertices on seams, with their values.
  [[nodiscard]] PointAttributes points();
  /// Returns the approximate bytes in memory.
  [[nodiscard]] uint64_t bytes() const;

 private:
  void correct(uint32_t e, Vec3f move, const Buffer<Vec3f>& positions);
  [[nodiscard]] std::vector<ValueChannel> channels(float step) const;
  [[nodiscard]] ValueResiduals no_residuals();
  void finish(const ValueResiduals& residuals, float step);

  std::vector<Track> tracks_;
  Buffer<uint32_t> vertices_;
  DetailLevel level_;
  bool is_split_ = false;  ///< whether `level_` is decoded; level() then makes the next level on demand
  ValueModels models_;
  ValueResiduals at_vertex_;  ///< [components][V]; 0 on the base
};

}  // namespace papilio
