#pragma once

#include <vector>

#include "base/ids.h"
#include "papilio/mesh.h"

namespace papilio {

/// Number of chosen edges at each vertex, at most 3, and the exclusive or of their other ends. [V]
struct VertexDegrees {
  VertexDegrees() = default;
  /// Counts the edges for which `is_chosen` is true. O(V + E).
  template <class IsChosen>
  VertexDegrees(const Topology& mesh, const IsChosen& is_chosen)
      : degree(mesh.vertex_count, 0), neighbours(mesh.vertex_count, 0) {
    const auto join = [&](VertexId v, uint32_t other) {
      if (degree[v] < 3) ++degree[v];
      neighbours[v] ^= other;
    };
    for (EdgeId e = 0; e < mesh.edge_count(); ++e) {
      if (!is_chosen(e)) continue;
      const HalfEdgeId h = mesh.half_edge[e];
      join(mesh.origin[h], mesh.tip(h));
      join(mesh.tip(h), mesh.origin[h]);
    }
  }

  std::vector<uint8_t> degree;
  std::vector<uint32_t> neighbours;
};

/// Continuation of boundaries, shared edges and creases beyond the ends of their edges.
///
/// At a vertex with exactly two curve edges, the curve goes from one to the other. At a vertex with more, a boundary
/// continues along the rim of its own faces (pinched vertices), and any other curve ends: its continuation must be
/// equal for all faces at the edge, or a crack would open. At a corner (`ShapeMarks::corners`) every curve ends.
class CurveNeighbours {
 public:
  /// Counts curve edges. O(V + E). The topology must outlive this.
  explicit CurveNeighbours(const Topology& mesh);

  /// Returns the curve's next vertex beyond the origin of h, which lies on a curve edge; `none` where the curve ends.
  [[nodiscard]] uint32_t before(HalfEdgeId h) const;
  /// Returns the curve's next vertex beyond the tip of h; `none` where the curve ends.
  [[nodiscard]] uint32_t after(HalfEdgeId h) const;

 private:
  [[nodiscard]] bool passes_through(VertexId vertex) const { return curves_.degree[vertex] == 2; }

  static constexpr uint8_t ends_here = 4;

  const Topology& mesh_;
  VertexDegrees curves_;  ///< degrees of curve edges; the degree of a corner is `ends_here`
};

}  // namespace papilio
