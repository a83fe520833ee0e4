#pragma once

#include <array>

#include "base/ids.h"
#include "mesh/part.h"

namespace papilio {

/// Four children of a face, their parent (split_in_four.h), and the vertices across their outer sides. It is read from
/// the parent's level: so the children are split in turn without connectivity of their own.
///
///            corner 2              Sides are the parent's: side i runs from corner i to corner i + 1. Child i < 3 has
///             /    \               corner i, child 3 lies in the middle. The parent must have a twin at each side.
///            /  2   \              Vertices and edges are of the children's level, numbered by `numbers`.
///     middle 2 --- middle 1
///       /    \  3  /   \           across_first[i]: the vertex across the first half of side i, at corner i;
///      /  0   \   /  1  \          across_second[i]: the vertex across its second half.
/// corner 0 -- middle 0 -- corner 1
class ChildStencil {
 public:
  ChildStencil(const Topology& parents, uint32_t parent)
      : ChildStencil(parents, parent, OwnNumbers(parents.edge_count())) {}
  template <class Numbers>
  ChildStencil(const Topology& parents, uint32_t parent, const Numbers& numbers)
      : first_inner_(2 * numbers.edge_count() + 3 * numbers.face(parent)) {
    for (uint32_t i = 0; i < 3; ++i) {
      const HalfEdgeId h = 3 * parent + i;
      const HalfEdgeId t = parents.twin[h];
      const uint32_t first = 3 * t.face();
      corner[i] = parents.origin[h];
      twin[i] = t;
      const EdgeId e = parents.edge[h];
      edge_[i] = numbers.edge(e);
      middle[i] = parents.vertex_count + e;
      across_first[i] = parents.vertex_count + parents.edge[first + next_side[t - first]];
      across_second[i] = parents.vertex_count + parents.edge[first + previous_side[t - first]];
    }
  }

  /// Returns the edge that is the half of side i at corner i, or at corner i + 1.
  [[nodiscard]] uint32_t first_half(uint32_t i) const { return 2 * edge_[i] + is_downward(i); }
  [[nodiscard]] uint32_t second_half(uint32_t i) const { return 2 * edge_[i] + 1 - is_downward(i); }
  /// Returns the edge between child i and child 3.
  [[nodiscard]] uint32_t inner_edge(uint32_t i) const { return first_inner_ + i; }

  std::array<uint32_t, 3> corner, middle, across_first, across_second;
  std::array<uint32_t, 3> twin;  ///< twin of each side, in the parent's level

 private:
  // Branch-free: which side two faces share is unpredictable.
  static constexpr std::array<uint8_t, 3> next_side{1, 2, 0}, previous_side{2, 0, 1};

  /// Returns 1 if side i runs to its lower vertex. The half at the lower vertex has the lower number.
  [[nodiscard]] uint32_t is_downward(uint32_t i) const { return corner[i] > corner[(i + 1) % 3] ? 1 : 0; }

  std::array<uint32_t, 3> edge_;  ///< number of each side's edge
  uint32_t first_inner_;
};

}  // namespace papilio
