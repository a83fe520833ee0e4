#include "tests/support/openmesh_oracle.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/ModifiedButterFlyT.hh>
#include <stdexcept>

namespace papilio::test {
namespace {

struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using DoubleMesh = OpenMesh::TriMesh_ArrayKernelT<DoubleTraits>;

}  // namespace

OracleResult openmesh_butterfly(const TriangleMesh& mesh, size_t levels) {
  DoubleMesh subdivided;
  std::vector<DoubleMesh::VertexHandle> handles;
  for (Vec3f p : mesh.positions) handles.push_back(subdivided.add_vertex({p.x, p.y, p.z}));
  for (const Triangle& t : mesh.triangles)
    if (!subdivided.add_face(handles[t[0]], handles[t[1]], handles[t[2]]).is_valid())
      throw std::invalid_argument("the oracle takes manifolds only");
  OpenMesh::Subdivider::Uniform::ModifiedButterflyT<DoubleMesh, double> subdivider;
  subdivider.attach(subdivided);
  subdivider(levels);
  subdivider.detach();
  OracleResult result;
  for (const auto vertex : subdivided.vertices()) {
    const auto& p = subdivided.point(vertex);
    result.positions.push_back({p[0], p[1], p[2]});
  }
  result.faces = subdivided.n_faces();
  return result;
}

}  // namespace papilio::test
