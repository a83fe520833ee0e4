#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <array>
#include <cstddef>
#include <vector>

// OpenMesh's quadric edge collapse (Garland and Heckbert 1997), with checks before and after.

namespace papilio::test {

struct DecimationTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
  VertexAttributes(OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge | OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status | OpenMesh::Attributes::Normal);
};
using DecimationMesh = OpenMesh::TriMesh_ArrayKernelT<DecimationTraits>;
using DecimationTriangle = std::array<int, 3>;

/// Adds the faces to a mesh that has the vertices, and drops vertices without a face. Throws `std::runtime_error`
/// unless the result is a manifold with finite coordinates.
void add_faces(DecimationMesh& mesh, const std::vector<DecimationTriangle>& triangles);

[[nodiscard]] std::vector<DecimationTriangle> triangles_of(const DecimationMesh& mesh);

/// Collapses edges until at most `faces` remain; a closed mesh has an even number of faces. The result is manifold, and
/// closed if the mesh is. Throws `std::runtime_error` if that is not possible.
void decimate(DecimationMesh& mesh, size_t faces);

}  // namespace papilio::test
