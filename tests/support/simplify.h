#pragma once

#include <cstddef>

#include "papilio/mesh.h"

namespace papilio::test {

/// Simplifies a mesh to at most `faces` triangles by quadric edge collapse (decimation.h), like simplify_mesh; points
/// of equal position are welded. The result is manifold, and closed if the mesh is. Throws `std::runtime_error` if the
/// mesh is no manifold or the count cannot be reached.
[[nodiscard]] TriangleMesh simplify(const TriangleMesh& mesh, size_t faces);

}  // namespace papilio::test
