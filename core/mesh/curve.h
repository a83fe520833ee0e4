#pragma once

#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// For each vertex [V] how many of some edges meet there, 3 standing for more, and the exclusive or of their other
/// ends.
struct VertexDegrees {
  VertexDegrees() = default;  ///< of no vertices
  /// Of the edges that are chosen. O(V + E).
  template <class IsChosen>
  VertexDegrees(const Topology& mesh, const IsChosen& is_chosen)
      : degree(mesh.vertex_count, 0), neighbours(mesh.vertex_count, 0) {
    const auto join = [&](uint32_t v, uint32_t other) {
      if (degree[v] < 3) ++degree[v];
      neighbours[v] ^= other;
    };
    for (uint32_t e = 0; e < mesh.edge_count(); ++e) {
      if (!is_chosen(e)) continue;
      const uint32_t h = mesh.half_edge[e];
      join(mesh.origin[h], mesh.tip(h));
      join(mesh.tip(h), mesh.origin[h]);
    }
  }

  std::vector<uint8_t> degree;
  std::vector<uint32_t> neighbours;
};

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
  [[nodiscard]] bool passes_through(uint32_t vertex) const { return curves_.degree[vertex] == 2; }

  static constexpr uint8_t ends_here = 4;

  const Topology& mesh_;
  VertexDegrees curves_;  ///< of curve edges; the degree of a corner is `ends_here`
};

}  // namespace papilio
