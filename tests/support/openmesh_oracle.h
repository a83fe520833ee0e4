#pragma once

#include <vector>

#include "papilio/mesh.h"

namespace papilio::test {

/// Subdivides a closed manifold `levels` times by OpenMesh's `ModifiedButterflyT` in double precision, an
/// independent implementation. Not valid for open meshes: OpenMesh uses ghost points at boundaries.
struct OracleResult {
  Buffer<Vec3d> positions;
  size_t faces = 0;
};
[[nodiscard]] OracleResult openmesh_butterfly(const TriangleMesh& mesh, size_t levels);

}  // namespace papilio::test
