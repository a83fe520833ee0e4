#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <stdexcept>

#include "papilio/refine.h"
#include "tests/bench/markdown_table.h"
#include "tests/bench/openmesh_peer.h"
#include "tests/bench/report.h"
#include "tests/support/real_mesh.h"

// The most memory that a uniform refinement in three levels takes at once, beside OpenMesh's: each in a process of its
// own, less what the process has before it.

namespace papilio::bench {
namespace {

/// Resident MiB, most so far.
double most_resident() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// What `work` adds in a child process.
double memory_of(const std::function<void()>& prepare_and_work) {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) {
    const double before = most_resident();
    prepare_and_work();
    const double added = most_resident() - before;
    const bool sent = ::write(ends[1], &added, sizeof(added)) == static_cast<ssize_t>(sizeof(added));
    std::_Exit(sent ? 0 : 1);
  }
  ::close(ends[1]);
  double added = 0;
  const bool received = ::read(ends[0], &added, sizeof(added)) == static_cast<ssize_t>(sizeof(added));
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  if (!received) throw std::runtime_error("the process that was measured has failed");
  return added;
}

std::vector<ReportRow> print() {
  constexpr int levels = 3;
  std::vector<ReportRow> rows;
  MarkdownTable table({"most memory at once, MiB", "ours", "OpenMesh", "ratio"});
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
  table.print();
  return rows;
}

}  // namespace

void add_memory() { add({"memory", print}); }

}  // namespace papilio::bench
