#pragma once

#include <cstdint>
#include <span>

#include "array.h"
#include "fan.h"
#include "mesh.h"

namespace papilio {

/// Where the plain rule for regular vertices does not hold. Where all edges are split, level by level, it is found once
/// on the coarse mesh and then followed: uniform levels make no others.
struct Features {
  struct Spoke {
    uint32_t half_edge;  ///< that leaves the centre
    uint32_t edge;       ///< its edge
    uint32_t tip;        ///< the vertex at its other end
    friend bool operator==(const Spoke&, const Spoke&) = default;
  };

  Array<uint32_t> curve_half_edges;  ///< those on boundaries, shared edges and creases
  /// The fans that are not regular (fan.h): their spokes, one fan after the other, in the order of the lowest half-edge
  /// of each. A closed fan starts there, an open one at its end.
  Array<Spoke> spokes;
  Array<uint32_t> first_spoke{0};  ///< [fans + 1]
  Array<uint32_t> centre;          ///< [fans]
  Array<uint8_t> is_closed;        ///< [fans]

  int level = 0;  ///< below the mesh on which they were found

  [[nodiscard]] size_t fan_count() const { return is_closed.size(); }
  [[nodiscard]] std::span<const Spoke> spokes_of(size_t fan) const {
    return {spokes.data() + first_spoke[fan], spokes.data() + first_spoke[fan + 1]};
  }
  /// Fills `fan` with the i-th; the mesh is that of the level.
  void fan(const Topology& mesh, size_t i, Fan& fan) const;
};

/// O(F + E).
[[nodiscard]] Features find_features(const Topology& mesh);

/// Those of the level below `mesh` (split_in_four.h). O(features).
void descend(Features& features, const Topology& mesh);

}  // namespace papilio
