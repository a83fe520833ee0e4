#pragma once

#include <cstdint>
#include <vector>

#include "base/ids.h"
#include "papilio/mesh.h"

namespace papilio {

/// Faces round one vertex, from curve to curve or all the way round, counter-clockwise.
struct Fan {
  VertexId centre = none;
  bool closed = false;           ///< whether the fan goes all the way round, without a curve
  std::vector<uint32_t> spokes;  ///< [K] half-edges that leave the centre, one a face; the face is on their left
  std::vector<uint32_t> ring;    ///< neighbours: [K] if closed, else [K + 1], first and last on the curve

  /// Returns K, the number of faces; in a closed fan, the vertex's valence.
  [[nodiscard]] uint32_t valence() const { return static_cast<uint32_t>(spokes.size()); }
};

/// Fills `fan` with the fan of half-edge h, which leaves the centre. An open fan starts at its clockwise end, a closed
/// one at h. The fan of a dart is closed.
void collect_fan(const Topology& mesh, HalfEdgeId h, Fan& fan);

/// Returns whether the vertex is a corner (`ShapeMarks::corners`): curves end there, and open fans follow the midpoint
/// rule.
[[nodiscard]] bool is_corner(const Topology& mesh, VertexId vertex);

/// Returns whether a single crease ends at the vertex (`Topology::darts`).
[[nodiscard]] bool is_dart(const Topology& mesh, VertexId vertex);

}  // namespace papilio
