#pragma once

#include <vector>

#include "papilio/mesh.h"

namespace papilio::test {

/// A closed manifold subdivided `levels` times by OpenMesh's `ModifiedButterflyT` in double precision: an
/// implementation that shares nothing with ours. (On open meshes it is no oracle: it uses ghost points at
/// boundaries.)
struct OracleResult {
  Buffer<Vec3d> positions;
  size_t faces = 0;
};
[[nodiscard]] OracleResult openmesh_butterfly(const TriangleMesh& mesh, size_t levels);

}  // namespace papilio::test
