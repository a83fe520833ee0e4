#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "base/poller.h"
#include "papilio/mesh.h"

namespace papilio {

/// Surface from which the quadric of an edge is made.
enum class Quadrics {
  accumulated,  ///< planes of the original at the merged vertices (Garland and Heckbert)
  /// planes of the remaining faces (Lindstrom and Turk, "Evaluation of Memoryless Simplification", 1999): slower, and
  /// nearer to the original
  memoryless,
};

/// Simplifies a mesh to at most `faces` triangles each, in descending order, by one sequence of quadric edge collapses
/// with optimal placement (Garland and Heckbert, "Surface Simplification Using Quadric Error Metrics", 1997). Planes
/// are weighted by area, boundaries are held by perpendicular planes, and the new vertex minimizes the quadric. Counts
/// that cannot be reached are left out at the end.
///
/// Points of equal position are merged. Non-manifold surfaces are cut into manifold sheets, whose borders move
/// separately. Collapses that change the topology or turn a face over are refused, and those after which a vertex of
/// the original is farther than `largest` from the faces that have replaced those around it.
[[nodiscard]] std::vector<TriangleMesh> collapse_to_sizes(const TriangleMesh& mesh, std::span<const size_t> faces,
                                                          Quadrics quadrics = Quadrics::accumulated,
                                                          const Poller& poller = {},
                                                          double largest = std::numeric_limits<double>::infinity());

}  // namespace papilio
