#pragma once

#include <cstdint>
#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// The faces round one vertex, from curve to curve or all the way round, counter-clockwise.
struct Fan {
  uint32_t centre = none;
  bool closed = false;           ///< all the way round, no curve in it
  std::vector<uint32_t> spokes;  ///< [K] half-edges that leave the centre, one a face; the face is on their left
  std::vector<uint32_t> ring;    ///< the neighbours: [K] when closed, else [K + 1], first and last on the curve

  /// K: the number of faces, which is the vertex's valence when closed.
  [[nodiscard]] uint32_t valence() const { return static_cast<uint32_t>(spokes.size()); }
};

/// Fills `fan` with the fan that half-edge h, which leaves the centre, is in. An open fan starts at its
/// clockwise end, a closed one at h. Round a dart it is closed.
void collect_fan(const Topology& mesh, uint32_t h, Fan& fan);

/// Whether curves end at the vertex, and open fans have the midpoint rule (`ShapeMarks::corners`).
[[nodiscard]] bool is_corner(const Topology& mesh, uint32_t vertex);

/// Whether a single crease ends at the vertex (`Topology::darts`).
[[nodiscard]] bool is_dart(const Topology& mesh, uint32_t vertex);

}  // namespace papilio
