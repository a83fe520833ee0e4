#include "hierarchy/level_choice.h"

#include <algorithm>

namespace papilio {
namespace {

/// Returns the children of faces of the level above.
Buffer<uint32_t> children_of(const Buffer<uint32_t>& parents, const HierarchyLevel& level) {
  auto faces = Buffer<uint32_t>::for_overwrite(4 * parents.size());
  uint32_t* to = faces.data();
  for (FaceId f : parents) {
    const uint32_t first = level.first_child_of(f);
    for (uint32_t c = 0; c < 4; ++c) *to++ = first + c;
  }
  return faces;
}

/// Marks the edges all of whose faces are in the region, which must be below level 0. [E]
Marks edges_of(const HierarchyLevel& level, const Buffer<uint32_t>& faces) {
  const Topology& mesh = level.mesh.topology;
  Buffer<uint8_t> is_in(mesh.face_count() / 4 + 1, 0);  // one entry per four children; the last is for no face
  for (size_t i = 0; i < faces.size(); i += 4) is_in[faces[i] / 4] = 1;
  is_in.back() = 1;
  Marks marks(mesh.edge_count(), 0);
  const uint32_t families = mesh.face_count() / 4;
  for (size_t i = 0; i < faces.size(); i += 4) {
    const uint32_t* twin = &mesh.twin[size_t{3} * faces[i]];
    const uint32_t* edge = &mesh.edge[size_t{3} * faces[i]];
    // The halves of each side have adjacent numbers and one neighbour; edges between the four children
    // are also adjacent.
    for (const uint32_t first : {0, 4, 8}) {
      uint8_t* halves = &marks[edge[first] & ~1U];
      halves[0] = halves[1] = is_in[std::min(twin[first] / 12, families)];
    }
    std::fill_n(&marks[edge[11]], 3, uint8_t{1});
  }
  for (HalfEdgeId h : level.shared)
    if (is_in[h / 12] == 0) marks[mesh.edge[h]] = 0;
  return marks;
}

}  // namespace

uint64_t LevelChoice::count_faces_of_split() const {
  const Topology& mesh = level->mesh.topology;
  if (level->features.curve_half_edges.empty()) return 2 * split_edges.size();
  uint64_t count = 0;
  for (EdgeId e : split_edges) {
    const EdgeKind kind = mesh.kind[e];
    count += kind == EdgeKind::boundary ? 1 : kind == EdgeKind::shared ? 0 : 2;
  }
  for (HalfEdgeId h : level->shared) count += split[mesh.edge[h]];
  return count;
}

Buffer<uint8_t> LevelChoice::with_children() const {
  const Topology& mesh = level->mesh.topology;
  return red.empty() ? Buffer<uint8_t>(mesh.face_count(), 0) : with_neighbours(mesh, red);
}

LevelChoice choose_coarsest(std::shared_ptr<const HierarchyLevel> level) {
  LevelChoice choice;
  choice.region = whole_region(level->mesh.topology);
  choice.split.assign(level->mesh.topology.edge_count(), 0);
  choice.level = std::move(level);
  return choice;
}

LevelChoice choose_below(const LevelChoice& above, std::shared_ptr<const HierarchyLevel> level) {
  LevelChoice choice;
  choice.region.faces = children_of(chosen(above.region.faces, [&](FaceId f) { return above.red[f] != 0; }), *level);
  choice.region.has_edge = edges_of(*level, choice.region.faces);
  choice.split.assign(level->mesh.topology.edge_count(), 0);
  choice.level = std::move(level);
  return choice;
}

void mark_red(LevelChoice& choice, const Buffer<uint32_t>& faces) {
  const Topology& mesh = choice.level->mesh.topology;
  choice.red.assign(mesh.face_count(), 0);
  for (FaceId f : faces) choice.red[f] = 1;
}

}  // namespace papilio
