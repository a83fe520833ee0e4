#pragma once

#include <span>

#include "mesh/blended_points.h"
#include "mesh/draft.h"
#include "mesh/t_junctions.h"

namespace papilio {

/// Inserts vertices in the edges of a connected draft: divides the faces on whose sides they lie. A face stays whole
/// where a part would turn over or lose its area, or a half-edge would run as another does. Attributes are interpolated
/// along the edge in the face's own chart. `Draft::tracked` becomes the vertices of the insertions. Counts the vertices
/// inserted. O(H log H).
[[nodiscard]] Draft divide_faces(const Draft& draft, std::span<const Insertion> insertions, BlendedPoints& points);

}  // namespace papilio
