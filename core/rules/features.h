#pragma once

#include <cstdint>
#include <span>

#include "mesh/fan.h"
#include "papilio/buffer.h"
#include "papilio/mesh.h"
#include "rules/stencil.h"

namespace papilio {

/// Vertices and edges at which the plain rule for regular vertices does not hold. Where all edges are split, level by
/// level, they are found once on the coarse mesh and then followed: uniform levels add no others.
struct Features {
  struct Spoke {
    uint32_t half_edge;  ///< half-edge that leaves the centre
    EdgeId edge;         ///< edge of `half_edge`
    uint32_t tip;        ///< vertex at the other end
    friend bool operator==(const Spoke&, const Spoke&) = default;
  };

  Buffer<uint32_t> curve_half_edges;  ///< on boundaries, shared edges and creases; not at cuts
  /// Spokes of the irregular fans (fan.h), one fan after the other. First come vertices with no other fan and no curve.
  /// They are sorted by valence (as far as weights are listed, stencil.h) and then by number, so that equal fans are
  /// adjacent. Then come the others, in the order of their lowest half-edges. A closed fan starts at its lowest
  /// half-edge, an open one at its end.
  Buffer<Spoke> spokes;
  Buffer<uint32_t> first_spoke{0};  ///< [fans + 1]
  Buffer<uint32_t> centre;          ///< [fans]
  Buffer<uint8_t> is_closed;        ///< [fans]

  bool has_darts = false;  ///< whether the mesh has darts: its fans are tested one by one

  int level = 0;  ///< number of levels below the mesh on which they were found

  [[nodiscard]] size_t fan_count() const { return is_closed.size(); }
  [[nodiscard]] std::span<const Spoke> spokes_of(size_t fan) const {
    return {spokes.data() + first_spoke[fan], spokes.data() + first_spoke[fan + 1]};
  }
  /// Returns whether fan i is closed, without a crease in it, and small enough for its weights to be listed
  /// (stencil.h). False for all fans of a mesh with darts.
  [[nodiscard]] bool is_ring(size_t i) const {
    return is_closed[i] != 0 && !has_darts && first_spoke[i + 1] - first_spoke[i] < stencil::harmonic_valence;
  }
  /// Returns whether all fans are rings, and there are no curves.
  [[nodiscard]] bool are_rings() const;
  /// Fills `fan` with fan i; the mesh is that of the level.
  void fan(const Topology& mesh, size_t i, Fan& fan) const;
};

/// Returns whether the regular rules apply to the fan's spokes: it is closed with six faces, or open with three. They
/// never apply to a dart, as they look for curves edge by edge, nor to a corner, where a curve ends.
[[nodiscard]] bool is_regular(const Topology& mesh, const Fan& fan);

/// Finds the features at the vertices that are not at cuts. O(F + E).
[[nodiscard]] Features find_features(const Topology& mesh);

/// Replaces the features of a level with `vertex_count` vertices by the features of the level below
/// (split_in_four.h). O(features).
void descend(Features& features, uint32_t vertex_count);

}  // namespace papilio
