#include <cstdlib>

#include "papilio/refine.h"
#include "tests/bench/markdown_table.h"
#include "tests/bench/openmesh_peer.h"
#include "tests/bench/report.h"
#include "tests/support/peak_memory.h"
#include "tests/support/real_mesh.h"
#include "tests/support/scene_memory.h"

// Peak memory of a uniform refinement in three levels compared with OpenMesh's, and of a scene's refinement compared
// with the sum of input scene, output scene and refinement of its mesh. Each runs in a process of its own; the memory
// before it is subtracted.

namespace papilio::bench {
namespace {

using test::peak_memory_of;

std::vector<ReportRow> print() {
  constexpr int levels = 3;
  std::vector<ReportRow> rows;
  MarkdownTable table({"most memory at once, MiB", "ours", "OpenMesh; of a scene: in, out and core", "ratio"});
  for (const char* name : {"elephant20k.drc", "elephant89k.drc"}) {
    const TriangleMesh coarse = test::real_mesh(name);
    const double ours = peak_memory_of([&] {
      Options options;
      options.levels = levels;
      options.tension = Tension::off;
      options.edges = false;
      const Result result = refine(build_mesh(coarse), options);
      if (result.mesh.topology.face_count() == 0) std::abort();
    });
    const double peer = peak_memory_of([&] {
      PeerMesh mesh = to_peer(coarse);
      subdivide(mesh, levels);
      if (mesh.n_faces() == 0) std::abort();
    });
    rows.push_back({"memory/" + std::string(name) + "/" + std::to_string(levels), ours, peer, "MiB"});
    table.add({rows.back().name, fixed(ours, 1), fixed(peer, 1), fixed(ours / peer, 2)});
  }
  const auto add_scene = [&](const test::MeasuredScene& scene) {
    const test::SceneMemory memory = test::measure_scene(scene.glb, scene.fields);
    rows.push_back({"memory/scene/" + scene.name, memory.taken, memory.allowed, "MiB"});
    table.add(
        {rows.back().name, fixed(memory.taken, 1), fixed(memory.allowed, 1), fixed(memory.taken / memory.allowed, 2)});
  };
  const TriangleMesh mesh = test::real_mesh("elephant20k.drc");
  for (const test::MeasuredScene& scene : test::measured_scenes(mesh, test::real_mesh("elephant2k.drc")))
    add_scene(scene);
  add_scene(test::measured_packed_model(mesh));
  table.print();
  return rows;
}

}  // namespace

void add_memory() { add({"memory", print}); }

}  // namespace papilio::bench
