#pragma once

#include "hierarchy/level_choice.h"

// Upper bounds of the surface's moves from level to level. Their sum over the levels bounds the distance between an
// undivided face and the uniform surface. It decides how deep levels are explored, and leaves most faces out of the
// comparison with the surface.

namespace papilio {

/// Returns an upper bound, in the mesh's unit, of the two-sided distance between the surface before and after an edge
/// is split. A bound up to `enough` may be loose. It depends on the edge's neighbourhood alone.
[[nodiscard]] double move_bound(const LevelChoice& choice, EdgeId edge, double enough);

/// Returns how far the surface moves where the edge of a half-edge is split, squared: the new vertex from the faces
/// before, or the middle of the edge from those after.
[[nodiscard]] double squared_move(const Mesh& whole, HalfEdgeId h, Vec3d made);

/// Returns for each face [F] of the choice's region the largest move bound of its edges.
[[nodiscard]] Buffer<float> largest_moves(const LevelChoice& choice, double enough);

/// Returns for each face [F] of `below`'s region the sum of the largest moves of the undivided faces above it. `sums`
/// [F] and `moves` [F] belong to `above`.
[[nodiscard]] Buffer<float> sums_above(const LevelChoice& above, const Buffer<float>& sums, const Buffer<float>& moves,
                                       const LevelChoice& below);

/// Marks the vertices [V] of faces below which the distance may exceed the allowed one [F], or be a larger share of it
/// than any known distance. Further levels are assumed to add at most half of the largest move at a face's corners, or
/// all of it if every known distance is below the allowed one.
[[nodiscard]] Buffer<uint8_t> vertices_that_may_leave(const LevelChoice& choice, const Buffer<float>& sums,
                                                      const Buffer<float>& moves, const Buffer<float>& allowed);

/// Returns for each face of each level [level][F] the largest sum of moves from it down. Below a face that was not
/// explored of the first `level_count` levels, half of its own move is added, where a smooth surface moves by a third.
/// `enough`: see move_bound().
[[nodiscard]] std::vector<Buffer<float>> sums_below(std::span<const LevelChoice> levels, int level_count,
                                                    double enough);

}  // namespace papilio
