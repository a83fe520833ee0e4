#pragma once

#include <array>

#include "mesh/part.h"

namespace papilio {

/// The four faces that one face, their parent, is split into (split_in_four.h), and the vertices across their outer
/// sides. All is read off the level of the parent: with it the children are split in turn without being connected.
///
///            corner 2              Sides are the parent's: side i runs from corner i to corner i + 1. Child i < 3 has
///             /    \               corner i, child 3 lies in the middle. The parent must have a twin at each side.
///            /  2   \              Vertices and edges are those of the children's level, which has these `numbers`.
///     middle 2 --- middle 1
///       /    \  3  /   \           across_first[i]: the vertex across the first half of side i, at corner i;
///      /  0   \   /  1  \          across_second[i]: the one across its second half.
/// corner 0 -- middle 0 -- corner 1
class ChildStencil {
 public:
  ChildStencil(const Topology& parents, uint32_t parent)
      : ChildStencil(parents, parent, OwnNumbers(parents.edge_count())) {}
  template <class Numbers>
  ChildStencil(const Topology& parents, uint32_t parent, const Numbers& numbers)
      : first_inner_(2 * numbers.edge_count() + 3 * numbers.face(parent)) {
    for (uint32_t i = 0; i < 3; ++i) {
      const uint32_t h = 3 * parent + i;
      const uint32_t t = parents.twin[h];
      const uint32_t first = 3 * Topology::face(t);
      corner[i] = parents.origin[h];
      twin[i] = t;
      const uint32_t e = parents.edge[h];
      edge_[i] = numbers.edge(e);
      middle[i] = parents.vertex_count + e;
      across_first[i] = parents.vertex_count + parents.edge[first + next_side[t - first]];
      across_second[i] = parents.vertex_count + parents.edge[first + previous_side[t - first]];
    }
  }

  /// The two halves of side i.
  [[nodiscard]] uint32_t first_half(uint32_t i) const { return 2 * edge_[i] + is_downward(i); }
  [[nodiscard]] uint32_t second_half(uint32_t i) const { return 2 * edge_[i] + 1 - is_downward(i); }
  /// The edge between child i and child 3.
  [[nodiscard]] uint32_t inner_edge(uint32_t i) const { return first_inner_ + i; }

  std::array<uint32_t, 3> corner, middle, across_first, across_second;
  std::array<uint32_t, 3> twin;  ///< of each side, in the parent's level

 private:
  // Without a branch: which side it is that two faces share nobody can guess.
  static constexpr std::array<uint8_t, 3> next_side{1, 2, 0}, previous_side{2, 0, 1};

  /// The half at the lower vertex has the lower number.
  [[nodiscard]] uint32_t is_downward(uint32_t i) const { return corner[i] > corner[(i + 1) % 3] ? 1 : 0; }

  std::array<uint32_t, 3> edge_;  ///< number of each side's
  uint32_t first_inner_;
};

}  // namespace papilio
