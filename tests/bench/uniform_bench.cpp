#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/ModifiedButterFlyT.hh>
#include <memory>

#include "core/refine.h"
#include "tests/bench/pairs.h"
#include "tests/support/real_mesh.h"

// Uniform subdivision, subdividing only, float: against OpenMesh's ModifiedButterflyT, the fastest other
// butterfly.

namespace papilio::bench {
namespace {

using PeerMesh = OpenMesh::TriMesh_ArrayKernelT<>;

PeerMesh to_peer(const TriangleMesh& mesh) {
  PeerMesh out;
  for (Vec3f p : mesh.positions) out.add_vertex({p.x, p.y, p.z});
  for (const Triangle& t : mesh.triangles)
    out.add_face(PeerMesh::VertexHandle(static_cast<int>(t[0])), PeerMesh::VertexHandle(static_cast<int>(t[1])),
                 PeerMesh::VertexHandle(static_cast<int>(t[2])));
  return out;
}

}  // namespace

void add_uniform() {
  for (const char* name : {"bunny600.obj", "elephant2000.obj"}) {
    const TriangleMesh triangles = test::real_mesh(name);
    const auto ours = std::make_shared<Mesh>(build_mesh(triangles));
    const auto peer = std::make_shared<PeerMesh>(to_peer(ours->triangles()));
    for (int levels : {1, 2, 3, 4}) {
      Options options;
      options.levels = levels;
      options.tension = Tension::off;
      add({.name = "uniform/" + std::string(name) + "/" + std::to_string(levels),
           .divisor = static_cast<double>(triangles.triangles.size() << (2U * static_cast<unsigned>(levels))),
           .unit = "ns/triangle out",
           .ours =
               [ours, options] {
                 Mesh mesh = *ours;
                 return seconds([&] { (void)refine(std::move(mesh), options); });
               },
           .peer =
               [peer, levels] {
                 PeerMesh mesh = *peer;
                 OpenMesh::Subdivider::Uniform::ModifiedButterflyT<PeerMesh, float> subdivider;
                 subdivider.attach(mesh);
                 const double time = seconds([&] { subdivider(static_cast<size_t>(levels)); });
                 subdivider.detach();
                 return time;
               }});
    }
  }
}

}  // namespace papilio::bench
