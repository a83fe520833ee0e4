#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "detail/detail_level.h"
#include "detail/texcoord_residuals.h"
#include "papilio/detail.h"
#include "papilio/mesh.h"

namespace papilio {

/// Texture coordinates of the levels of a base, on the surface that is cut along its seams: what decoder and encoder
/// compute alike. Each level predicts the coordinates of its new vertices by the rules of the positions within the
/// charts, corrected for where the positions came to lie, and adds residuals.
class TexcoordLevels {
 public:
  /// Of a base with texture coordinates, cut along these seams. Throws `Error` not_finite.
  TexcoordLevels(const Mesh& base, const std::vector<uint32_t>& seams);

  /// Predicts the coordinates of a level's new vertices: `whole` is the level as it is not cut, `positions` [V + E] and
  /// more are its vertices with the new ones.
  void predict(const Topology& whole, const Buffer<Vec3f>& positions);
  /// Decodes the residuals of the level that is predicted, and goes on to the next one. `pieces` of its edges; a step
  /// of 0: all residuals are 0. Throws `Error` not_finite.
  void decode(const EdgePieces& pieces, const PieceBytes& bytes, float step);
  /// Codes the residuals that lead to `wanted` [E], or to within 3/4 of a step, for the level that is predicted, and
  /// goes on to the next one. Returns the bytes of its pieces; none where all residuals are 0.
  [[nodiscard]] std::vector<std::vector<uint8_t>> encode(const EdgePieces& pieces, const Buffer<Vec3f>& wanted,
                                                         float step);

  /// The level that is cut: the one that is predicted, or is to be. Stays as it is until the next call after `decode`
  /// or `encode`.
  [[nodiscard]] const DetailLevel& level();
  /// Texture coordinates (u, v, 0) [V], and of a predicted level [V + E].
  [[nodiscard]] const Buffer<Vec3f>& values() const { return values_; }
  /// The vertex of the surface that is not cut at each one of it, as many.
  [[nodiscard]] const Buffer<uint32_t>& vertices() const { return vertices_; }
  /// Returns the texture coordinates of the points on the half-edges of the level that was decoded last [H]; before
  /// level() is called again.
  [[nodiscard]] Buffer<Texcoord> on_half_edges() const;
  /// Returns the points of all levels so far, several at vertices on seams, with their texture coordinates.
  [[nodiscard]] PointAttributes points();
  /// Bytes in memory, about.
  [[nodiscard]] uint64_t bytes() const;

 private:
  void correct(uint32_t e, Vec3f move, const Buffer<Vec3f>& positions);
  void finish(const TexcoordResiduals& residuals, float step);

  Buffer<Vec3f> values_;
  Buffer<uint32_t> vertices_;
  DetailLevel level_;
  bool is_split_ = false;  ///< whether `level_` is decoded: connectivity below it is made when it is needed
  std::unique_ptr<TexcoordModels> models_ = std::make_unique<TexcoordModels>();
  TexcoordResiduals at_vertex_;  ///< [V]; 0 on the base
};

}  // namespace papilio
