#pragma once

#include <vector>

#include "memo.h"
#include "mesh.h"
#include "region.h"
#include "split_plan.h"

namespace papilio {

/// Of each smooth edge [E] the product of its faces' unit normals, or, where one has none, more than any threshold;
/// infinity where it was not asked for yet. May be empty: then nothing is kept.
using NormalProducts = Memo<float>;

/// The edges that are not flat, the paper's section 3.1.1: those of two faces whose unit normals have n1.n2 <
/// `threshold` (less 4e-7, the rounding of float normals, so that what is flat stays whole at 1 too). An edge
/// on a curve (boundary, shared, crease) stays as sharp as it is: it is among them when the curve turns by more than
/// acos(threshold) at one of its ends. A cut edge never is; an edge at a face without area is not on that face's
/// account. Of a mesh only the region is looked at. In ascending order. Shape: normals [F].
[[nodiscard]] List<uint32_t> find_curved(const Mesh& mesh, const Array<Vec3f>& normals, const NormalProducts& products,
                                         double threshold, const Region& region);
/// Marks [E] them, of all the mesh.
void mark_by_flatness(const Mesh& mesh, const Array<Vec3f>& normals, double threshold, EdgeMarks& marks);

/// How far marks spread, the paper's section 3.1.2.
enum class Growth {
  off = 0,
  faces = 1,     ///< to the other edges of the two faces at a marked edge
  vertices = 2,  ///< to all edges at the two ends of a marked edge
};

/// Marks the seeds and their 1-neighbouring edges (one step: new marks do not spread again). Within the region, of
/// which all seeds are. Marks [E].
void grow(const Topology& mesh, Growth growth, const List<uint32_t>& seeds, const Region& region, EdgeMarks& marks);
/// The same for what is marked, of all the mesh.
void grow(const Topology& mesh, Growth growth, EdgeMarks& marks);

}  // namespace papilio
