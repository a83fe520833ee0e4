#include "tests/bench/openmesh_peer.h"

#include <OpenMesh/Tools/Subdivider/Uniform/ModifiedButterFlyT.hh>

namespace papilio::bench {

PeerMesh to_peer(const TriangleMesh& mesh) {
  PeerMesh out;
  for (Vec3f p : mesh.positions) out.add_vertex({p.x, p.y, p.z});
  for (const Triangle& t : mesh.triangles)
    out.add_face(PeerMesh::VertexHandle(static_cast<int>(t[0])), PeerMesh::VertexHandle(static_cast<int>(t[1])),
                 PeerMesh::VertexHandle(static_cast<int>(t[2])));
  return out;
}

using Subdivider = OpenMesh::Subdivider::Uniform::ModifiedButterflyT<PeerMesh, float>;

void subdivide(PeerMesh& mesh, int levels) {
  Subdivider subdivider;
  subdivider.attach(mesh);
  subdivider(static_cast<size_t>(levels));
  subdivider.detach();
}

TriangleMesh to_triangles(const PeerMesh& mesh) {
  TriangleMesh out;
  out.positions.reserve(mesh.n_vertices());
  out.triangles.reserve(mesh.n_faces());
  for (const auto v : mesh.vertices()) {
    const auto p = mesh.point(v);
    out.positions.push_back({p[0], p[1], p[2]});
  }
  for (const auto f : mesh.faces()) {
    Triangle corners{};
    size_t i = 0;
    for (const auto v : f.vertices()) corners[i++] = static_cast<uint32_t>(v.idx());
    out.triangles.push_back(corners);
  }
  return out;
}

}  // namespace papilio::bench
