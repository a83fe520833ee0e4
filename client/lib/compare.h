#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "papilio/mesh.h"

namespace papilio::client {

struct CompareOptions {
  /// Number of points sampled on each surface by area, besides all its vertices. More samples find smaller bumps, and
  /// take longer. 0: only vertices.
  size_t samples = 50'000;
};

/// Distances between two surfaces, in the meshes' unit. Forward is from points of a to the nearest point of b's
/// surface, which may be small even if a lacks a part of b; backward is from b to a.
struct Comparison {
  double hausdorff = 0;     ///< larger of `max_forward` and `max_backward`
  double rms = 0;           ///< larger of `rms_forward` and `rms_backward`
  double max_forward = 0;   ///< largest distance from a to b, over vertices and samples: a lower bound of the exact one
  double max_backward = 0;  ///< largest distance from b to a
  double rms_forward = 0;   ///< root mean square distance from a to b over the area (or vertices, if there is no area)
  double rms_backward = 0;  ///< root mean square distance from b to a
  double diagonal = 0;      ///< diagonal of the bounding box of a's triangles, the unit of shares
  /// Mean angle between the normals at a sample and at its nearest point, over samples of both directions; degrees,
  /// 0..180. If several faces meet at that point, the normal of best agreement counts. 0 if no face has a normal.
  double normal_degrees_mean = 0;
};

/// Measures the distances between two meshes from samples; distances to triangles are exact, except for rounding.
/// Deterministic. After Aspert, Santa-Cruz and Ebrahimi, "MESH: measuring errors between surfaces using the Hausdorff
/// distance" (2002). Degenerate triangles count as the segments or points that they cover; unused positions are
/// ignored.
///
/// Throws `std::invalid_argument`, with the mesh's name in `names`, for no triangles, an index out of range, or a
/// coordinate that is not finite.
[[nodiscard]] Comparison compare(const TriangleMesh& a, const TriangleMesh& b, const CompareOptions& options = {},
                                 const std::array<std::string, 2>& names = {"the first mesh", "the second mesh"});

}  // namespace papilio::client
