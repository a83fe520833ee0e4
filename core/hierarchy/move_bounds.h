#pragma once

#include "hierarchy/level_choice.h"

// Bounds of how far the surface moves from level to level. Their sum over the levels bounds the distance between a face
// that is not divided and the uniform surface: by it the levels are explored, and most faces are known to be near
// enough.

namespace papilio {

/// Upper bound, in the mesh's unit, of the distance between the surface and what splitting an edge makes of it, from
/// both sides. A bound up to `enough` may be loose. It depends on the edge's surroundings alone.
[[nodiscard]] double move_bound(const LevelChoice& choice, uint32_t edge, double enough);

/// The largest bound at the edges of each face [F] of the choice's region.
[[nodiscard]] Buffer<float> largest_moves(const LevelChoice& choice, double enough);

/// For each face [F] of `below`'s region the sum of the largest moves of the undivided faces above it; `sums` [F] and
/// `moves` [F] are those of `above`.
[[nodiscard]] Buffer<float> sums_above(const LevelChoice& above, const Buffer<float>& sums, const Buffer<float>& moves,
                                       const LevelChoice& below);

/// Marks the vertices [V] of the faces below which the distance may exceed what is allowed [F], or be a larger share of
/// that than any known one. What further levels add is taken to be no more than the largest move at a face's corners.
[[nodiscard]] Buffer<uint8_t> vertices_that_may_leave(const LevelChoice& choice, const Buffer<float>& sums,
                                                      const Buffer<float>& moves, const Buffer<float>& allowed);

/// For each face of each level [level][F] the largest sum of moves from it down. Below a face that was not explored of
/// the first `level_count` levels, half of its own is added, where a smooth surface moves by a third. `enough` as
/// above.
[[nodiscard]] std::vector<Buffer<float>> sums_below(std::span<const LevelChoice> levels, int level_count,
                                                    double enough);

}  // namespace papilio
