#pragma once

#include <array>
#include <cstdint>

// The four children of a face whose edges are all split (split_in_four.h), with twelve half-edges, three a child.

namespace papilio {

/// Returns the child half-edge from the origin of half-edge h to the middle of its edge.
[[nodiscard]] constexpr uint32_t first_half(uint32_t h) { return 4 * h; }

/// Returns the child half-edge from the middle of half-edge h's edge to the tip of h.
[[nodiscard]] constexpr uint32_t second_half(uint32_t h) {
  // Half-edge i of child i + 1 mod 3: 12 f + 3 (i + 1 mod 3) + i, where h = 3 f + i.
  return h % 3 == 2 ? 4 * h - 6 : 4 * h + 3;
}

using OfSides = std::array<uint32_t, 3>;  ///< one number a side of the parent, side i running from its corner i

/// Stores the numbers one by one: copying them from an array would stall on its stores.
template <class... Numbers>
void put(uint32_t* at, Numbers... numbers) {
  ((*at++ = numbers), ...);
}

/// Stores the corners of the children [12], from the parent's corners and the middles of its sides.
inline void put_corners_of_four(const OfSides& corner, const OfSides& middle, uint32_t* to) {
  put(to, corner[0], middle[0], middle[2],  //
      middle[0], corner[1], middle[1],      //
      middle[2], middle[1], corner[2],      //
      middle[0], middle[1], middle[2]);
}

/// Stores the twins of the children's half-edges [12], given the twins of the first and second halves of the parent's
/// sides. `base` is the first child's first half-edge.
inline void put_twins_of_four(uint32_t base, const OfSides& against_first, const OfSides& against_second,
                              uint32_t* to) {
  put(to, against_first[0], base + 11, against_second[2],  //
      against_second[0], against_first[1], base + 9,       //
      base + 10, against_second[1], against_first[2],      //
      base + 5, base + 6, base + 1);
}

/// Stores the edges of the children's half-edges [12], given the edges of the halves of the parent's sides. The three
/// inner edges start at `inner`.
inline void put_edges_of_four(const OfSides& first, const OfSides& second, uint32_t inner, uint32_t* to) {
  put(to, first[0], inner, second[2],  //
      second[0], first[1], inner + 1,  //
      inner + 2, second[1], first[2],  //
      inner + 1, inner + 2, inner);
}

/// Returns the six vertices of the children, from their corners [12]: the parent's corners, then the middles of its
/// sides.
[[nodiscard]] inline std::array<uint32_t, 6> vertices_of_four(const uint32_t* corner) {
  return {corner[0], corner[4], corner[8], corner[9], corner[10], corner[11]};
}

/// Calls visit(half-edge, from, to) for each of the children's nine edges: the number of its half-edge, 0..11, and of
/// its vertices in vertices_of_four(). Unrolled, so that all numbers are compile-time constants.
template <class Visit>
[[gnu::always_inline]] inline void visit_edges_of_four(const Visit& visit) {
  visit(0, 0, 3);
  visit(3, 3, 1);
  visit(4, 1, 4);
  visit(7, 4, 2);
  visit(8, 2, 5);
  visit(2, 5, 0);
  visit(9, 3, 4);
  visit(10, 4, 5);
  visit(11, 5, 3);
}

}  // namespace papilio
