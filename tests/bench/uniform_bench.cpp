#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/ModifiedButterFlyT.hh>
#include <memory>

#include "core/refine.h"
#include "tests/bench/pairs.h"
#include "tests/support/real_mesh.h"

// Uniform subdivision in float, one thread, closed meshes in Draco's order: against OpenMesh's ModifiedButterflyT, the
// fastest other butterfly.

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

Options uniform_options(int levels) {
  Options options;
  options.levels = levels;
  options.tension = Tension::off;
  options.edges = false;
  return options;
}

double triangles_out(const TriangleMesh& coarse, int levels) {
  return static_cast<double>(coarse.triangles.size() << (2U * static_cast<unsigned>(levels)));
}

/// Subdividing alone, from a mesh that is built.
void add_subdivision(const std::string& name, const TriangleMesh& triangles, int levels) {
  const auto ours = std::make_shared<Mesh>(build_mesh(triangles));
  const auto peer = std::make_shared<PeerMesh>(to_peer(ours->triangles()));
  add({.name = "uniform/" + name + "/" + std::to_string(levels),
       .divisor = triangles_out(triangles, levels),
       .unit = "ns/triangle out",
       .ours =
           [ours, levels] {
             Mesh mesh = *ours;
             return seconds([&] { (void)refine(std::move(mesh), uniform_options(levels)); });
           },
       .peer =
           [peer, levels] {
             PeerMesh mesh = *peer;
             return seconds([&] { subdivide(mesh, levels); });
           }});
}

/// From triangles to triangles: building, subdividing, taking out.
void add_whole(const std::string& name, const TriangleMesh& triangles, int levels) {
  const auto coarse = std::make_shared<TriangleMesh>(triangles);
  add({.name = "triangles/" + name + "/" + std::to_string(levels),
       .divisor = triangles_out(triangles, levels),
       .unit = "ns/triangle out",
       .ours =
           [coarse, levels] {
             return seconds([&] { (void)refine(build_mesh(*coarse), uniform_options(levels)).mesh.triangles(); });
           },
       .peer =
           [coarse, levels] {
             return seconds([&] {
               PeerMesh mesh = to_peer(*coarse);
               subdivide(mesh, levels);
               (void)to_triangles(mesh);
             });
           }});
}

}  // namespace

void add_uniform() {
  for (const char* name : {"bunny600.obj", "elephant2k.drc", "elephant20k.drc", "elephant89k.drc"}) {
    const TriangleMesh triangles = test::real_mesh(name);
    for (int levels : {1, 2, 3}) add_subdivision(name, triangles, levels);
  }
  add_whole("elephant20k.drc", test::real_mesh("elephant20k.drc"), 2);
}

}  // namespace papilio::bench
