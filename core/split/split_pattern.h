#pragma once

#include <array>
#include <cstdint>

#include "papilio/mesh.h"

namespace papilio {

/// Division of one face into children. Local vertices: 0, 1, 2 are the face's corners, 3 + i the new vertex of its edge
/// i, from corner i to corner (i + 1) % 3. Child half-edges are numbered 3c + s: side s of child c.
struct SplitPattern {
  uint8_t children = 0;
  std::array<std::array<uint8_t, 3>, 4> corner{};  ///< [child][side] local vertex at which the side starts
  /// [child half-edge] the child half-edge on the other side if that is inside the face; else `outside`.
  std::array<uint8_t, 12> inner_twin{};
  /// [child half-edge] number of its edge among those inside the face. If outside: 2i for the first half (or the whole)
  /// of edge i, 2i + 1 for the second half.
  std::array<uint8_t, 12> edge{};
  /// [2i + half] the child half-edge that is the first half (or the whole) or the second half of edge i.
  std::array<uint8_t, 6> outer{};

  static constexpr uint8_t outside = 255;
  [[nodiscard]] bool is_outside(uint32_t half_edge) const { return inner_twin[half_edge] == outside; }
};

/// All patterns: [2 * mask + (second diagonal ? 1 : 0)].
extern const std::array<SplitPattern, 16> split_patterns;

/// Returns the pattern of a face: `mask` has bit i set if edge i is a target; `second_diagonal` chooses the cut of the
/// quadrangle that two target edges leave. There, edges i and j = (i + 1) % 3 are targets. The first diagonal runs from
/// corner i to the vertex of edge j, the second from the vertex of edge i to corner (j + 1) % 3.
[[nodiscard]] inline const SplitPattern& split_pattern(unsigned mask, bool second_diagonal) {
  return split_patterns[2 * mask + (second_diagonal ? 1 : 0)];
}

[[nodiscard]] constexpr bool has_two_targets(unsigned mask) { return (0b01101000U >> mask & 1U) != 0; }
/// [mask] the only target edge; of two targets, edge i of split_pattern().
inline constexpr std::array<uint8_t, 8> first_target{0, 0, 1, 0, 2, 2, 1, 0};
/// Corners and edges in cyclic order, starting from turned[i].
inline constexpr std::array<uint8_t, 5> turned{0, 1, 2, 0, 1};

}  // namespace papilio
