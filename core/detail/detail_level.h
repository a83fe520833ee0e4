#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "detail/residual_context.h"
#include "papilio/detail.h"
#include "papilio/mesh.h"
#include "rules/features.h"

namespace papilio {

/// Residual of an edge as far as it is coded, in one place: contexts look at a dozen edges each.
struct CodedResidual {
  static constexpr uint16_t no_piece = most_detail_pieces;
  int32_t along_normal = 0;
  uint16_t piece = no_piece;  ///< in which it is coded
  bool is_free = false;       ///< whether it has tangential parts
};

/// Level of the hierarchy, whose edges are all split. Decoder and encoder share it.
class DetailLevel {
 public:
  /// Makes level 0, the base, perhaps with curves. `seams`: edges on seams, in ascending order. Smooth edges on seams
  /// are predicted as other smooth edges, but have residuals of curves, which keep the seam in place.
  explicit DetailLevel(Topology base, const std::vector<uint32_t>& seams = {});
  /// Returns the next level.
  [[nodiscard]] DetailLevel next() const;

  [[nodiscard]] const Topology& topology() const { return topology_; }
  [[nodiscard]] Topology take_topology() && { return std::move(topology_); }
  [[nodiscard]] uint32_t number() const { return number_; }
  /// Returns [C] the edges on boundaries, creases and seams, in ascending order. Each becomes two on the next level.
  [[nodiscard]] std::span<const uint32_t> curve_edges() const { return curve_edges_; }

  /// Predicts the new vertices and appends them: `positions` [V] grow to [V + E].
  void predict(Buffer<Vec3f>& positions) const;

  /// Returns the coding context of edge e's residual along `normal`, in `piece`; where the normal is zero, the bow is
  /// not known. `coded` [E]; `at_vertex` [V]: residuals of the vertices. `positions` [V + E] include the predictions.
  [[nodiscard]] ResidualContext context(uint32_t e, uint32_t piece, std::span<const CodedResidual> coded,
                                        std::span<const int32_t> at_vertex, const Vec3f* positions, Vec3f normal,
                                        float step) const;
  /// Returns the coding context of the residual of curve_edges()[c]. In `residual` [E] and `across` [C], earlier edges
  /// are coded.
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
