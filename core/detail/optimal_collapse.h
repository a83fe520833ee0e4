#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// Surface from which the quadric of an edge is made.
enum class Quadrics {
  accumulated,  ///< the planes of the original at the vertices that have become one (Garland and Heckbert)
  /// the planes of the faces left so far (Lindstrom and Turk, "Evaluation of Memoryless Simplification", 1999): slower
  /// and nearer
  memoryless,
};

/// Simplifies a mesh to at most so many triangles by quadric edge collapse with optimal placement (Garland and
/// Heckbert, "Surface Simplification Using Quadric Error Metrics", 1997): planes weighted by area, boundaries held by
/// perpendicular planes, the new vertex where the quadric is least. Points of equal position are one. Where the surface
/// is not a manifold it is cut into manifold sheets, whose borders move separately. Collapses that change the topology
/// or turn a face over are refused. One sequence of collapses gives all counts of `faces`, which must descend. Counts
/// that cannot be reached are left out at the end. `poll` is called every few thousand collapses and may throw to stop.
[[nodiscard]] std::vector<TriangleMesh> collapse_to_sizes(const TriangleMesh& mesh, std::span<const size_t> faces,
                                                          Quadrics quadrics = Quadrics::accumulated,
                                                          const std::function<void()>& poll = {});

}  // namespace papilio
