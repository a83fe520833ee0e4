#pragma once

#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// How boundaries, shared edges and creases go on beyond the ends of their edges.
///
/// At a vertex with exactly two curve edges the curve goes from one to the other. Where more meet, a boundary
/// edge goes on along the rim of its own faces (pinched vertices), and any other curve ends: what several
/// faces share must not depend on which of them asks, or a crack would open. At a corner (`ShapeMarks::corners`) every
/// curve ends.
class CurveNeighbours {
 public:
  /// O(V + E). The topology must outlive this.
  explicit CurveNeighbours(const Topology& mesh);

  /// The curve's next vertex beyond the origin of h, which lies on a curve edge; `none` where the curve ends.
  [[nodiscard]] uint32_t before(uint32_t h) const;
  /// The same beyond the tip of h.
  [[nodiscard]] uint32_t after(uint32_t h) const;

 private:
  [[nodiscard]] bool passes_through(uint32_t vertex) const { return degree_[vertex] == 2; }

  static constexpr uint8_t ends_here = 4;

  const Topology& mesh_;
  std::vector<uint8_t> degree_;  ///< [V] curve edges at the vertex, 3 standing for more; or `ends_here`, at a corner
  std::vector<uint32_t> neighbours_;  ///< [V] exclusive or of their other ends
};

}  // namespace papilio
