#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "detail/residual_models.h"
#include "papilio/mesh.h"
#include "rules/features.h"

namespace papilio {

/// Residuals of a level's edges [E], of which those before an edge, in its piece, are coded.
struct CodedResiduals {
  std::span<const int32_t> residual;
  std::span<const uint8_t> is_free;
  std::span<const uint16_t> piece;
};

/// A level of the hierarchy whose edges are all split: what decoder and encoder compute alike.
class DetailLevel {
 public:
  /// The base, perhaps with curves; `number` 0. `seams`: edges on seams, in ascending order. Those that are smooth are
  /// predicted as others, but have the residuals of curves, which keep the seam in its place.
  explicit DetailLevel(Topology base, const std::vector<uint32_t>& seams = {});
  /// The next level.
  [[nodiscard]] DetailLevel next() const;

  [[nodiscard]] const Topology& topology() const { return topology_; }
  [[nodiscard]] Topology take_topology() && { return std::move(topology_); }
  [[nodiscard]] uint32_t number() const { return number_; }
  /// Edges on boundaries, creases and seams, in ascending order [C]. Those of the next level come from them, two from
  /// each.
  [[nodiscard]] std::span<const uint32_t> curve_edges() const { return curve_edges_; }

  /// Predicts the new vertices: `positions` [V] grow to [V + E].
  void predict(Buffer<Vec3f>& positions) const;

  /// What is known of the residual of edge e. `at_vertex` [V] are those of the vertices; `positions` [V + E] hold the
  /// predictions.
  [[nodiscard]] ResidualContext context(uint32_t e, const CodedResiduals& coded, std::span<const int32_t> at_vertex,
                                        const Vec3f* positions, float step) const;
  /// What is known of the residual of the curve's edge of number c. `residual` [E], `across` [C]: those before are
  /// coded.
  [[nodiscard]] CurveContext curve_context(uint32_t c, std::span<const int32_t> residual,
                                           std::span<const int32_t> across, std::span<const int32_t> at_vertex) const;

 private:
  DetailLevel() = default;
  Topology topology_;
  Features features_;
  Buffer<uint32_t> curve_edges_;
  uint32_t number_ = 0, vertices_before_ = 0;
};

}  // namespace papilio
