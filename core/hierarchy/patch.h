#pragma once

#include <array>

#include "hierarchy/result_surface.h"
#include "simd/extremes.h"

// Parts of a result over a face of a level, and over the face's descendants.

namespace papilio {

[[nodiscard]] inline double squared_norm(Vec3d a) { return dot(a, a); }
[[nodiscard]] inline Vec3d middle_of(Vec3d a, Vec3d b) { return 0.5 * (a + b); }
[[nodiscard]] inline Corners middles_of(const Corners& corner) {
  return {middle_of(corner[0], corner[1]), middle_of(corner[1], corner[2]), middle_of(corner[2], corner[0])};
}
/// Returns the largest squared distance of three pairs of points.
[[nodiscard]] inline double largest_squared_distance(const Corners& some, const Corners& others) {
  double largest = 0;
  for (uint32_t i = 0; i < 3; ++i) largest = larger(largest, squared_norm(some[i] - others[i]));
  return largest;
}

/// Returns the corners of a face's children (four_children.h), from its corners and new vertices.
[[nodiscard]] inline std::array<Corners, 4> children_of(const Corners& corner, const Corners& made) {
  return {{{corner[0], made[0], made[2]}, {made[0], corner[1], made[1]}, {made[2], made[1], corner[2]}, made}};
}
/// Sides of children 0, 1 and 2 at the middle child.
inline constexpr std::array<uint32_t, 3> inner_side{1, 2, 0};

/// Triangle, or two triangles that meet in the line from the middle of a side to the opposite corner.
struct Patch {
  Corners corner{};
  uint32_t bent_side = none;  ///< runs from the corner of this number to the next
  Vec3d bend{};               ///< its middle
  unsigned ridges = 0;        ///< sides, by bits, at which the result may be bent; of two patches' common sides, one

  [[nodiscard]] Corners middles() const {
    Corners middle = middles_of(corner);
    if (bent_side != none) middle[bent_side] = bend;
    return middle;
  }
  [[nodiscard]] Vec3d opposite_bend() const { return corner[(bent_side + 2) % 3]; }
};

/// Returns the largest squared distance between points of a patch and of a triangle with equal barycentric coordinates.
/// Both are linear between the corners and the bend.
[[nodiscard]] inline double largest_squared_distance(const Patch& patch, const Corners& triangle) {
  const double at_corners = largest_squared_distance(patch.corner, triangle);
  if (patch.bent_side == none) return at_corners;
  const Vec3d middle = middle_of(triangle[patch.bent_side], triangle[(patch.bent_side + 1) % 3]);
  return larger(at_corners, squared_norm(patch.bend - middle));
}

/// Patches over the four children of a face.
using Patches = std::array<Patch, 4>;

/// Returns patches that are triangles. `middle`: places of the new vertices; `ridges` of the face.
[[nodiscard]] Patches patches_over(const Corners& corner, const Corners& middle, unsigned ridges);

/// Bends the child at a corner and the one in the middle along the line to that corner from the middle of the opposite
/// side.
void bend_along(Patches& patches, uint32_t corner, Vec3d from, Vec3d to);

/// Returns the patches over the children of the face under `patch`; `middle`: see Patch::middles().
[[nodiscard]] Patches patches_below(const Patch& patch, const Corners& middle);

/// Places on an undivided face: its corners, the surface's new vertices, and where these are in the result.
struct LeafCorners {
  const Corners &corner, &made, &middle;
};

/// Returns the pieces of an undivided face as patches over its children.
[[nodiscard]] Patches patches_over_leaf(const ResultSurface& result, const LevelFace& leaf, const LeafCorners& at);

}  // namespace papilio
