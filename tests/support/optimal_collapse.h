#pragma once

#include <cstddef>

#include "papilio/mesh.h"

namespace papilio::test {

/// At most `faces` triangles by quadric edge collapse with optimal placement (Garland and Heckbert, "Surface
/// Simplification Using Quadric Error Metrics", 1997): planes weighted by area, boundaries held by perpendicular
/// planes, the new vertex where the quadric is least. Points of equal position are one. Collapses that change the
/// topology or turn a face over are refused. Throws `std::runtime_error` if the mesh is not a manifold or the count
/// cannot be reached.
[[nodiscard]] TriangleMesh collapse_optimally(const TriangleMesh& mesh, size_t faces);

}  // namespace papilio::test
