#include "hierarchy/grow_level.h"

#include "mesh/normals.h"

namespace papilio {
namespace {

Buffer<Vec3f> grown_normals(const Mesh& mesh, const Buffer<Vec3f>& known, const Buffer<uint32_t>& moved) {
  auto normals = Buffer<Vec3f>::for_overwrite(mesh.topology.face_count());
  Buffer<uint8_t> is_known(normals.size(), 0);
  for (uint32_t f = 0; f < moved.size(); ++f) {
    normals[moved[f]] = known[f];
    is_known[moved[f]] = 1;
  }
  for (uint32_t f = 0; f < normals.size(); ++f)
    if (is_known[f] == 0) normals[f] = face_normal(mesh, f);
  return normals;
}

/// For each edge of the level the number of its vertex among those that the known level has made; `none`. [E]
Buffer<uint32_t> find_known_vertices(const Topology& mesh, const HierarchyLevel& known, const Buffer<uint32_t>& moved) {
  Buffer<uint32_t> rank(mesh.edge_count(), none);
  for (uint32_t h = 0; h < known.mesh.topology.half_edge_count(); ++h) {
    const uint32_t e = known.mesh.topology.edge[h];
    if (known.trial.tried.is_split(e)) rank[mesh.edge[3 * moved[h / 3] + h % 3]] = known.trial.tried.before[e];
  }
  return rank;
}

}  // namespace

void try_grown_level(HierarchyLevel& level, const Options& options, const HierarchyLevel& known,
                     const Buffer<uint32_t>& moved) {
  const Buffer<uint32_t> rank = find_known_vertices(level.mesh.topology, known, moved);
  EdgeMarks marks = complete_edges(level);
  Trial& trial = level.trial;
  trial = {.normals = grown_normals(level.mesh, known.trial.normals, moved), .tried = SplitPlan(marks)};
  for (uint32_t e = 0; e < marks.size(); ++e)
    if (rank[e] != none) marks[e] = 0;
  const SplitPlan rest(marks);
  const Buffer<Vec3f> made = make_vertices(level.mesh, trial.normals, options, rest);

  trial.made.resize_for_overwrite(trial.tried.count());
  trial.keep(level.mesh.topology);
  for (uint32_t e = 0; e < marks.size(); ++e) {
    if (!trial.tried.is_split(e)) continue;
    const uint32_t at = trial.tried.before[e];
    trial.made[at] = rank[e] == none ? made[rest.before[e]] : known.trial.made[rank[e]];
    if (rank[e] == none) continue;
    trial.deviations.put(at, known.trial.deviations.get(rank[e]));
    trial.bounds.put(at, known.trial.bounds.get(rank[e]));
  }
}

}  // namespace papilio
