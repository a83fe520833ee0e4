#pragma once

#include <vector>

#include "mesh/marks.h"
#include "mesh/region.h"
#include "papilio/mesh.h"
#include "papilio/options.h"

namespace papilio {

/// Marks the edges that are not flat, the paper's section 3.1.1: their two faces' unit normals have n1.n2 <
/// `threshold`. The threshold is lowered by 4e-7, the rounding of float normals, so that flat regions stay whole at 1
/// too. An edge on a curve (boundary, shared, crease) is marked if the curve turns by more than acos(threshold) at one
/// of its ends. A cut edge is never marked, nor a smooth edge at a face without area. Marks are then grown. Reads only
/// the region. Shapes: normals [F], marks [E].
[[nodiscard]] Marks find_curved(const Mesh& mesh, const Buffer<Vec3f>& normals, double threshold, Growth growth,
                                const Region& region);

/// Marks the 1-neighbouring edges of the marked ones as well (one step: new marks do not spread). Reads only the
/// region, which must contain all marked edges; new marks are in it, too. Marks [E].
void grow(const Topology& mesh, Growth growth, const Region& region, Marks& marks);

}  // namespace papilio
