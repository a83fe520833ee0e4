#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "papilio/mesh.h"

namespace papilio::client {

/// Returns the position of a corner; NaN where the file has none.
using CornerPosition = std::function<Vec3f(uint32_t corner)>;

/// Cuts a polygon into triangles of its orientation and appends them; nothing for one or two corners.
///
/// The fan around the first corner is kept unless another cut is clearly better: neighbouring quads that all have their
/// diagonal in one direction give vertices of valence six, which subdivision likes best.
/// - A plane quad is cut along the diagonal inside it. Of two such diagonals, as of a bent quad's, it is the one with
///   the clearly flatter fold, else the one with the clearly larger smallest angle, else the one at the first corner.
/// - A plane polygon of more corners is cut by ear clipping, shortest diagonal first, in O(n^2).
/// - A fan remains what is bent, crosses itself, has no area, has a position that is not finite, or has more than
///   `most_clipped_corners`.
void append_polygon(std::span<const uint32_t> corners, const CornerPosition& position, Buffer<Triangle>& triangles);

inline constexpr size_t most_clipped_corners = 1024;

/// Polygons of a file whose faces may come before its positions.
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
