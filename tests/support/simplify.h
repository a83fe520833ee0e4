#pragma once

#include <cstddef>

#include "papilio/mesh.h"

namespace papilio::test {

/// At most `faces` triangles by quadric edge collapse (decimation.h), as simplify_mesh makes them; points of equal
/// position are one. The result is manifold, and closed when the mesh is. Throws `std::runtime_error` when the mesh is
/// no manifold or the count cannot be reached.
[[nodiscard]] TriangleMesh simplify(const TriangleMesh& mesh, size_t faces);

}  // namespace papilio::test
