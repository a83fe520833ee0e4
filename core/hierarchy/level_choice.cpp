#include "hierarchy/level_choice.h"

#include <algorithm>

namespace papilio {
namespace {

/// The children of faces of the level above.
Buffer<uint32_t> children_of(const Buffer<uint32_t>& parents, const HierarchyLevel& level) {
  Buffer<uint32_t> faces(4 * parents.size());
  uint32_t* to = faces.data();
  for (uint32_t f : parents) {
    const uint32_t first = level.first_child_of(f);
    for (uint32_t c = 0; c < 4; ++c) *to++ = first + c;
  }
  return faces;
}

/// The edges all of whose faces are in the region, which lies below level 0. [E]
EdgeMarks edges_of(const HierarchyLevel& level, const Buffer<uint32_t>& faces) {
  const Topology& mesh = level.mesh.topology;
  Buffer<uint8_t> is_in(mesh.face_count() / 4 + 1, 0);  // children come by four; the last stands for no face at all
  for (size_t i = 0; i < faces.size(); i += 4) is_in[faces[i] / 4] = 1;
  is_in.back() = 1;
  EdgeMarks marks(mesh.edge_count(), 0);
  const uint32_t families = mesh.face_count() / 4;
  for (size_t i = 0; i < faces.size(); i += 4) {
    const uint32_t* twin = &mesh.twin[size_t{3} * faces[i]];
    const uint32_t* edge = &mesh.edge[size_t{3} * faces[i]];
    // Two halves of each side, which lie together and have one neighbour; and the edges between the four, which do,
    // too.
    for (const uint32_t first : {0, 4, 8}) {
      uint8_t* halves = &marks[edge[first] & ~1U];
      halves[0] = halves[1] = is_in[std::min(twin[first] / 12, families)];
    }
    std::fill_n(&marks[edge[11]], 3, uint8_t{1});
  }
  for (uint32_t h : level.shared)
    if (is_in[h / 12] == 0) marks[mesh.edge[h]] = 0;
  return marks;
}

}  // namespace

uint64_t LevelChoice::count_faces_of_split() const {
  const Topology& mesh = level->mesh.topology;
  if (level->features.curve_half_edges.empty()) return 2 * split_edges.size();
  uint64_t count = 0;
  for (uint32_t e : split_edges) {
    const EdgeKind kind = mesh.kind[e];
    count += kind == EdgeKind::boundary ? 1 : kind == EdgeKind::shared ? 0 : 2;
  }
  for (uint32_t h : level->shared) count += split[mesh.edge[h]];
  return count;
}

bool LevelChoice::has_many_split() const {
  constexpr size_t few = 8;  // fewer than one edge for so many faces: then these are looked up
  return split_edges.size() * few > region.faces.size();
}

Buffer<LevelChoice::PartlySplit> LevelChoice::faces_split_in_part() const {
  const auto is_in_part = [](unsigned mask) { return (mask + 1) % 8 > 1; };
  const auto find = [&](const Buffer<uint32_t>& faces) {
    auto found =
        Buffer<PartlySplit>::for_overwrite(faces.size() + 1);  // what is not wanted is written, and then replaced
    size_t known = 0;
    for (uint32_t f : faces) {
      found[known] = {f, split_mask(f)};
      known += is_in_part(found[known].mask) ? 1 : 0;
    }
    found.resize_for_overwrite(known);
    return found;
  };
  return has_many_split() ? find(region.faces) : find(faces_at_split());
}

Buffer<uint32_t> LevelChoice::faces_at_split() const {
  if (has_many_split()) {
    Buffer<uint32_t> faces = region.faces;
    keep_if(faces, [this](uint32_t f) { return split_mask(f) != 0; });
    return faces;
  }
  const Topology& mesh = level->mesh.topology;
  Buffer<uint8_t> marks(mesh.face_count(), 0);
  for (uint32_t e : split_edges) {
    const uint32_t h = mesh.half_edge[e];
    marks[Topology::face(h)] = 1;
    if (mesh.twin[h] != none) marks[Topology::face(mesh.twin[h])] = 1;
  }
  for (uint32_t h : level->shared) marks[Topology::face(h)] |= split[mesh.edge[h]];
  return marked(marks);
}

Buffer<uint8_t> LevelChoice::with_children() const {
  const Topology& mesh = level->mesh.topology;
  return red.empty() ? Buffer<uint8_t>(mesh.face_count(), 0) : with_neighbours(mesh, red);
}

LevelChoice choose_coarsest(std::shared_ptr<const HierarchyLevel> level) {
  LevelChoice choice;
  choice.region = whole_region(level->mesh.topology);
  choice.region.has_curves = !level->features.curve_half_edges.empty();
  choice.split.assign(level->mesh.topology.edge_count(), 0);
  choice.level = std::move(level);
  return choice;
}

LevelChoice choose_below(const LevelChoice& above, std::shared_ptr<const HierarchyLevel> level) {
  LevelChoice choice;
  Buffer<uint32_t> red = above.region.faces;
  keep_if(red, [&](uint32_t f) { return above.red[f] != 0; });
  choice.region.has_curves = !level->features.curve_half_edges.empty();
  choice.region.faces = children_of(red, *level);
  choice.region.has_edge = edges_of(*level, choice.region.faces);
  choice.split.assign(level->mesh.topology.edge_count(), 0);
  choice.level = std::move(level);
  return choice;
}

void mark_red(LevelChoice& choice, const Buffer<uint32_t>& faces) {
  const Topology& mesh = choice.level->mesh.topology;
  choice.red.assign(mesh.face_count(), 0);
  for (uint32_t f : faces) choice.red[f] = 1;
}

}  // namespace papilio
