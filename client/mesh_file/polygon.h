#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "papilio/mesh.h"

namespace papilio::client {

/// Function that returns the position of a corner; NaN if the file has none.
using CornerPosition = std::function<Vec3f(uint32_t corner)>;

/// Triangulates a polygon with its orientation, and appends the triangles; none for one or two corners.
///
/// The fan around the first corner is kept unless another division is clearly better: diagonals of neighbouring quads
/// in one direction give vertices of valence six, which are regular in the subdivision.
/// - A plane quad is divided by its inner diagonal. Of two candidates, as in a bent quad, it is the one with the
/// clearly
///   flatter fold, else the one with the clearly larger smallest angle, else the one at the first corner.
/// - A plane polygon of more corners is triangulated by ear clipping, shortest diagonal first, in O(n^2).
/// - Other polygons are fans: bent or self-intersecting ones, without area, with a position that is not finite, or with
/// more
///   than `most_clipped_corners`.
void append_polygon(std::span<const uint32_t> corners, const CornerPosition& position, Buffer<Triangle>& triangles);

inline constexpr size_t most_clipped_corners = 1024;

/// Polygons of a file whose faces may precede its positions.
class PolygonList {
 public:
  void add(std::span<const uint32_t> corners);
  /// Returns the triangles of all polygons in order. `polygon_of`, unless null, receives the polygon of each.
  [[nodiscard]] Buffer<Triangle> triangles(const CornerPosition& position,
                                           std::vector<uint32_t>* polygon_of = nullptr) const;

 private:
  std::vector<uint32_t> corners_;  ///< corners of all polygons
  std::vector<size_t> ends_;       ///< end of each polygon in `corners_`
};

}  // namespace papilio::client
