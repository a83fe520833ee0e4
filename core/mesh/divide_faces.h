#pragma once

#include <span>

#include "mesh/blended_points.h"
#include "mesh/draft.h"
#include "mesh/t_junctions.h"

namespace papilio {

/// Inserts vertices in the edges of a connected draft, and divides the faces at those edges. A face stays whole if a
/// part would turn over or lose its area, or if two half-edges would run between two vertices in one direction.
/// Attributes are interpolated along the edge in the face's own chart. `Draft::tracked` becomes the vertices of the
/// insertions. Counts the inserted vertices. O(H log H).
[[nodiscard]] Draft divide_faces(const Draft& draft, std::span<const Insertion> insertions, BlendedPoints& points);

}  // namespace papilio
