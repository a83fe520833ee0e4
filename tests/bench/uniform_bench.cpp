#include <memory>

#include "papilio/refine.h"
#include "tests/bench/openmesh_peer.h"
#include "tests/bench/pairs.h"
#include "tests/support/real_mesh.h"

// Uniform subdivision in float of closed meshes in Draco's order with one thread, compared with OpenMesh's
// ModifiedButterflyT, the fastest other butterfly.

namespace papilio::bench {
namespace {

Options uniform_options(int levels) {
  Options options;
  options.levels = levels;
  options.tension = Tension::off;
  options.edges = false;
  options.measure_error = false;  // OpenMesh measures none
  return options;
}

double triangles_out(const TriangleMesh& coarse, int levels) {
  return static_cast<double>(coarse.triangles.size() << (2U * static_cast<unsigned>(levels)));
}

/// Subdivision of a built mesh; `with_error`: including the measurement of the remaining error.
void add_subdivision(const std::string& name, const TriangleMesh& triangles, int levels, bool with_error = false) {
  const auto ours = std::make_shared<Mesh>(build_mesh(triangles));
  const auto peer = std::make_shared<PeerMesh>(to_peer(ours->triangles()));
  Options options = uniform_options(levels);
  options.measure_error = with_error;
  add({.name = (with_error ? "uniform with its error/" : "uniform/") + name + "/" + std::to_string(levels),
       .divisor = triangles_out(triangles, levels),
       .unit = "ns/triangle out",
       .ours =
           [ours, options] {
             Mesh mesh = *ours;
             return seconds([&] { (void)refine(std::move(mesh), options); });
           },
       .peer =
           [peer, levels] {
             PeerMesh mesh = *peer;
             return seconds([&] { subdivide(mesh, levels); });
           }});
}

/// From triangles to triangles: building, subdividing, extracting.
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
  for (const char* name : {"elephant20k.drc", "elephant89k.drc"}) add_subdivision(name, test::real_mesh(name), 3, true);
  add_whole("elephant20k.drc", test::real_mesh("elephant20k.drc"), 2);
}

}  // namespace papilio::bench
