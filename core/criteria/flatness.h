#pragma once

#include <vector>

#include "base/lazy_values.h"
#include "mesh/region.h"
#include "mesh/split_plan.h"
#include "papilio/mesh.h"
#include "papilio/options.h"

namespace papilio {

/// Of each smooth edge [E] the product of its faces' unit normals, or, where one has none, more than any threshold;
/// infinity where it was not asked for yet. May be empty: then nothing is kept.
using NormalProducts = LazyValues<float>;

/// Marks the edges that are not flat, the paper's section 3.1.1: those of two faces whose unit normals have n1.n2 <
/// `threshold` (less 4e-7, the rounding of float normals, so that what is flat stays whole at 1 too). An edge
/// on a curve (boundary, shared, crease) stays as sharp as it is: it is among them when the curve turns by more than
/// acos(threshold) at one of its ends. A cut edge never is; an edge at a face without area is not on that face's
/// account. Lets them grow, too. Of a mesh only the region is looked at. Shapes: normals [F], marks [E].
[[nodiscard]] EdgeMarks find_curved(const Mesh& mesh, const Buffer<Vec3f>& normals, const NormalProducts& products,
                                    double threshold, Growth growth, const Region& region);

/// Marks the 1-neighbouring edges of those marked, too (one step: new marks do not spread again). Of a mesh only the
/// region is looked at, of which all marked edges are, before and afterwards. Marks [E].
void grow(const Topology& mesh, Growth growth, const Region& region, EdgeMarks& marks);

}  // namespace papilio
