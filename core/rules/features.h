#pragma once

#include <cstdint>
#include <span>

#include "mesh/fan.h"
#include "papilio/buffer.h"
#include "papilio/mesh.h"
#include "rules/stencil.h"

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

  Buffer<uint32_t> curve_half_edges;  ///< those on boundaries, shared edges and creases; not at cuts
  /// The fans that are not regular (fan.h): their spokes, one fan after the other. First those of vertices that have no
  /// other fan and no curve, by valence (as far as there is a list of weights, stencil.h) and then by number: alike
  /// ones lie together. Then the others, in the order of their lowest half-edges. A closed fan starts at its lowest
  /// half-edge, an open one at its end.
  Buffer<Spoke> spokes;
  Buffer<uint32_t> first_spoke{0};  ///< [fans + 1]
  Buffer<uint32_t> centre;          ///< [fans]
  Buffer<uint8_t> is_closed;        ///< [fans]

  bool has_darts = false;  ///< the mesh has: its fans are looked at one by one

  int level = 0;  ///< below the mesh on which they were found

  [[nodiscard]] size_t fan_count() const { return is_closed.size(); }
  [[nodiscard]] std::span<const Spoke> spokes_of(size_t fan) const {
    return {spokes.data() + first_spoke[fan], spokes.data() + first_spoke[fan + 1]};
  }
  /// Whether the i-th fan is all the way round, no crease in it, and small enough for its weights to be listed
  /// (stencil.h).
  [[nodiscard]] bool is_ring(size_t i) const {
    return is_closed[i] != 0 && !has_darts && first_spoke[i + 1] - first_spoke[i] < stencil::harmonic_valence;
  }
  /// Whether all fans are, and there are no curves.
  [[nodiscard]] bool are_rings() const;
  /// Fills `fan` with the i-th; the mesh is that of the level.
  void fan(const Topology& mesh, size_t i, Fan& fan) const;
};

/// Whether the regular rules apply to its spokes: closed with six faces, or open with three. To a dart they never do:
/// they look for curves edge by edge. Nor to a corner, where a curve ends.
[[nodiscard]] bool is_regular(const Topology& mesh, const Fan& fan);

/// Of the vertices that are not at cuts. O(F + E).
[[nodiscard]] Features find_features(const Topology& mesh);

/// Those of the level below one with so many vertices (split_in_four.h). O(features).
void descend(Features& features, uint32_t vertex_count);

}  // namespace papilio
