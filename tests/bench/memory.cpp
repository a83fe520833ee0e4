#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <stdexcept>

#include "papilio/refine.h"
#include "proto/gltf/scene_refinement.h"
#include "tests/bench/markdown_table.h"
#include "tests/bench/openmesh_peer.h"
#include "tests/bench/report.h"
#include "tests/bench/textured_scene.h"
#include "tests/support/real_mesh.h"

// The most memory that a uniform refinement in three levels takes at once, beside OpenMesh's; and that a scene takes,
// beside the scene that comes, the one that goes and the refinement of its mesh. Each in a process of its own, less
// what the process has before it.

namespace papilio::bench {
namespace {

/// Resident MiB, most so far.
double most_resident() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// What `work` returns in a child process.
double in_a_process(const std::function<double()>& work) {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) {
    const double found = work();
    const bool sent = ::write(ends[1], &found, sizeof(found)) == static_cast<ssize_t>(sizeof(found));
    std::_Exit(sent ? 0 : 1);
  }
  ::close(ends[1]);
  double found = 0;
  const bool received = ::read(ends[0], &found, sizeof(found)) == static_cast<ssize_t>(sizeof(found));
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  if (!received) throw std::runtime_error("the process that was measured has failed");
  return found;
}

/// What work adds to the memory of a child process.
double memory_of(const std::function<void()>& prepare_and_work) {
  return in_a_process([&] {
    const double before = most_resident();
    prepare_and_work();
    return most_resident() - before;
  });
}

/// What a scene with images of so many bytes takes, and the sum of its parts.
ReportRow scene_row(const std::string& name, size_t bytes_of_image) {
  constexpr double mebibyte = 1 << 20;
  const std::string glb = textured_scene(bytes_of_image);
  const proto::Parameters parameters = proto::parse_query({{"levels", "3"}});
  const double ours = memory_of([&] {
    const std::string own = glb;
    if (proto::gltf::SceneRefinement(own, parameters, {}).run().bytes.empty()) std::abort();
  });
  const double of_mesh = memory_of([&] {  // with what its points carry: face and place
    const auto mesh = proto::gltf::decode_scene(glb, {}).scene.meshes[0].surface.mesh;
    if (refine(mesh, {.levels = 3, .edges = false}).mesh.topology.face_count() == 0) std::abort();
  });
  const double written = in_a_process(
      [&] { return static_cast<double>(proto::gltf::SceneRefinement(glb, parameters, {}).run().bytes.size()); });
  return {name, ours, static_cast<double>(glb.size()) / mebibyte + written / mebibyte + of_mesh, "MiB"};
}

std::vector<ReportRow> print() {
  constexpr int levels = 3;
  std::vector<ReportRow> rows;
  MarkdownTable table({"most memory at once, MiB", "ours", "OpenMesh; of a scene: in, out and core", "ratio"});
  for (const char* name : {"elephant20k.drc", "elephant89k.drc"}) {
    const TriangleMesh coarse = test::real_mesh(name);
    const double ours = memory_of([&] {
      Options options;
      options.levels = levels;
      options.tension = Tension::off;
      options.edges = false;
      const Result result = refine(build_mesh(coarse), options);
      if (result.mesh.topology.face_count() == 0) std::abort();
    });
    const double peer = memory_of([&] {
      PeerMesh mesh = to_peer(coarse);
      subdivide(mesh, levels);
      if (mesh.n_faces() == 0) std::abort();
    });
    rows.push_back({"memory/" + std::string(name) + "/" + std::to_string(levels), ours, peer, "MiB"});
    table.add({rows.back().name, fixed(ours, 1), fixed(peer, 1), fixed(ours / peer, 2)});
  }
  for (ReportRow& row : std::vector{scene_row("memory/scene without images/3", 0),
                                    scene_row("memory/scene with 40 MB of images/3", 10 * image_bytes)}) {
    table.add({row.name, fixed(row.ours, 1), fixed(row.peer, 1), fixed(row.ours / row.peer, 2)});
    rows.push_back(std::move(row));
  }
  table.print();
  return rows;
}

}  // namespace

void add_memory() { add({"memory", print}); }

}  // namespace papilio::bench
