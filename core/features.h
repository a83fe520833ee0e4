#pragma once

#include <cstdint>
#include <vector>

#include "fan.h"
#include "mesh.h"

namespace papilio {

/// Where the plain rule for regular vertices does not hold on a mesh all of whose edges are split: found once on the
/// coarse mesh, then followed from level to level. Uniform levels make no others.
struct Features {
  std::vector<uint32_t> curve_half_edges;  ///< those on boundaries, shared edges and creases
  /// The irregular fans (fan.h): their spokes, one fan after the other, each where for_each_irregular_fan starts it.
  std::vector<uint32_t> spokes;
  std::vector<uint32_t> first_spoke{0};  ///< [fans + 1]
  std::vector<uint8_t> is_closed;        ///< [fans]

  int level = 0;  ///< below the mesh on which they were found

  [[nodiscard]] size_t fan_count() const { return is_closed.size(); }
  /// Fills `fan` with the i-th; the mesh is that of the level.
  void fan(const Topology& mesh, size_t i, Fan& fan) const;
};

/// O(F + E).
[[nodiscard]] Features find_features(const Topology& mesh);

/// Those of the next uniform level (split_in_four.h). O(features).
void descend(Features& features);

}  // namespace papilio
