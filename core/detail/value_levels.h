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

/// Texture coordinates and colours of the levels of a base, on the surface that is cut along its seams: what decoder
/// and encoder compute alike. Each level predicts the values of its new vertices by the rules of the positions within
/// the charts, corrected for where the positions came to lie, and adds residuals.
class ValueLevels {
 public:
  /// The values of one attribute.
  struct Track {
    uint32_t components = 0;  ///< 2 or 3
    /// [V], and of a predicted level [V + E]; the third component of texture coordinates is 0.
    Buffer<Vec3f> values{};
  };

  /// Of a base with values (base_attributes.h), cut along these seams. Throws `Error` not_finite.
  ValueLevels(const Mesh& base, const std::vector<uint32_t>& seams);

  /// Predicts the values of a level's new vertices: `whole` is the level as it is not cut, `positions` [V + E] and
  /// more are its vertices with the new ones.
  void predict(const Topology& whole, const Buffer<Vec3f>& positions);
  /// Decodes the residuals of the level that is predicted, and goes on to the next one. `pieces` of its edges; a step
  /// of 0: all residuals are 0. Throws `Error` not_finite.
  void decode(const EdgePieces& pieces, const PieceBytes& bytes, float step);
  /// Codes the residuals that lead to `wanted` [tracks][E], or to within 3/4 of a step, for the level that is
  /// predicted, and goes on to the next one. Returns the bytes of its pieces; none where all residuals are 0.
  [[nodiscard]] std::vector<std::vector<uint8_t>> encode(const EdgePieces& pieces,
                                                         std::span<const Buffer<Vec3f>> wanted, float step);

  /// The level that is cut: the one that is predicted, or is to be. Stays as it is until the next call after `decode`
  /// or `encode`.
  [[nodiscard]] const DetailLevel& level();
  /// The attributes, in the order of the base's.
  [[nodiscard]] const std::vector<Track>& tracks() const { return tracks_; }
  /// The vertex of the surface that is not cut at each one of it [V], and of a predicted level [V + E].
  [[nodiscard]] const Buffer<uint32_t>& vertices() const { return vertices_; }
  /// Returns the values of the track of so many components at the points on the half-edges of the level that was
  /// decoded last [H]; before level() is called again. Empty where there is none.
  template <size_t Components>
  [[nodiscard]] Buffer<std::array<float, Components>> on_half_edges() const;
  /// Returns the points of all levels so far, several at vertices on seams, with their values.
  [[nodiscard]] PointAttributes points();
  /// Bytes in memory, about.
  [[nodiscard]] uint64_t bytes() const;

 private:
  void correct(uint32_t e, Vec3f move, const Buffer<Vec3f>& positions);
  [[nodiscard]] std::vector<ValueChannel> channels(float step) const;
  [[nodiscard]] ValueResiduals no_residuals();
  void finish(const ValueResiduals& residuals, float step);

  std::vector<Track> tracks_;
  Buffer<uint32_t> vertices_;
  DetailLevel level_;
  bool is_split_ = false;  ///< whether `level_` is decoded: connectivity below it is made when it is needed
  ValueModels models_;
  ValueResiduals at_vertex_;  ///< [components][V]; 0 on the base
};

}  // namespace papilio
