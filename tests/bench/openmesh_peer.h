#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include "papilio/mesh.h"

// OpenMesh's ModifiedButterflyT, the fastest other butterfly, in float.

namespace papilio::bench {

using PeerMesh = OpenMesh::TriMesh_ArrayKernelT<>;

[[nodiscard]] PeerMesh to_peer(const TriangleMesh& mesh);
[[nodiscard]] TriangleMesh to_triangles(const PeerMesh& mesh);
void subdivide(PeerMesh& mesh, int levels);

}  // namespace papilio::bench
