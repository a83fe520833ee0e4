#pragma once

#include <cstdint>
#include <vector>

#include "fan.h"
#include "mesh.h"

namespace papilio {

/// Where the plain rule for regular vertices does not hold. Where all edges are split, level by level, it is found once
/// on the coarse mesh and then followed: uniform levels make no others.
struct Features {
  std::vector<uint32_t> curve_half_edges;  ///< those on boundaries, shared edges and creases
  /// The fans that are not regular (fan.h): their spokes, one fan after the other, in the order of the lowest spoke of
  /// each. A closed fan starts there, an open one at its end.
  std::vector<uint32_t> spokes;
  std::vector<uint32_t> edges, tips;     ///< [spokes] the edge of each, and the vertex at its other end
  std::vector<uint32_t> first_spoke{0};  ///< [fans + 1]
  std::vector<uint32_t> centre;          ///< [fans]
  std::vector<uint8_t> is_closed;        ///< [fans]

  int level = 0;  ///< below the mesh on which they were found

  [[nodiscard]] size_t fan_count() const { return is_closed.size(); }
  /// Fills `fan` with the i-th; the mesh is that of the level.
  void fan(const Topology& mesh, size_t i, Fan& fan) const;
};

/// O(F + E).
[[nodiscard]] Features find_features(const Topology& mesh);

/// Those of the level below `mesh` (split_in_four.h). O(features).
void descend(Features& features, const Topology& mesh);

}  // namespace papilio
