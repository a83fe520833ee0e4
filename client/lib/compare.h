#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "papilio/mesh.h"

namespace papilio::client {

struct CompareOptions {
  /// Points spread over each surface by area, besides all its vertices. More find smaller bumps and take
  /// longer. 0 looks at the vertices alone. Default 50,000.
  size_t samples = 50'000;
};

/// How far two surfaces are apart. Distances are in the meshes' own unit. Forward is from a to b: from points
/// of a to the nearest point of b's surface, which may be small though a lacks a part of b; backward the
/// other way.
struct Comparison {
  double hausdorff = 0;     ///< the larger of `max_forward` and `max_backward`
  double rms = 0;           ///< the larger of `rms_forward` and `rms_backward`
  double max_forward = 0;   ///< largest distance, over vertices and samples: a lower bound of the exact one
  double max_backward = 0;  ///< the same from b to a
  double rms_forward = 0;   ///< root mean square distance over the area (over the vertices if there is no area)
  double rms_backward = 0;  ///< the same from b to a
  double diagonal = 0;      ///< of the smallest box, along the axes, around a's triangles: what to divide by for shares
  /// Mean angle between the normals at a sample and at the point nearest to it, over the samples of both
  /// directions; degrees, 0 to 180. Where faces meet in that point, the one that agrees best counts. 0 where
  /// nothing has a normal.
  double normal_degrees_mean = 0;
};

/// Distances to triangles are exact but for rounding, the points they are measured from are samples. The same
/// input gives the same result. After Aspert, Santa-Cruz and Ebrahimi, "MESH: measuring errors between
/// surfaces using the Hausdorff distance" (2002). Degenerate triangles count as the segments or points that
/// they cover; positions that no triangle uses do not count.
///
/// Throws `std::invalid_argument`, which says which mesh, if one has no triangles, an index out of range, or
/// a coordinate that is not finite. `names` are what the meshes are called there.
[[nodiscard]] Comparison compare(const TriangleMesh& a, const TriangleMesh& b, const CompareOptions& options = {},
                                 const std::array<std::string, 2>& names = {"the first mesh", "the second mesh"});

}  // namespace papilio::client
