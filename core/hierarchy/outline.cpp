#include "hierarchy/outline.h"

#include <algorithm>
#include <utility>

#include "hierarchy/transition.h"

namespace papilio {
namespace {

/// Finds the faces that add_faces_at_outline() adds.
Buffer<uint32_t> faces_at_outline(const LevelChoice& choice, const Selection& selection) {
  const Topology& mesh = choice.level->mesh.topology;
  Buffer<uint8_t> has_wanted(mesh.vertex_count, 0);  // [V] at which an edge is wanted whose halves may be
  for (uint32_t e : choice.candidates)
    if (const uint32_t h = mesh.half_edge[e]; selection.may_have_long_halves(choice.level->mesh, e))
      has_wanted[mesh.origin[h]] = has_wanted[mesh.tip(h)] = 1;
  const auto touches = [&](const Buffer<uint8_t>& vertices, uint32_t f) {
    const uint32_t* corner = &mesh.origin[size_t{3} * f];
    return (vertices[corner[0]] | vertices[corner[1]] | vertices[corner[2]]) != 0;
  };
  Buffer<uint32_t> faces = choice.region.faces;
  keep_if(faces, [&](uint32_t f) { return choice.split_mask(f) != 7 && touches(has_wanted, f); });
  Buffer<uint8_t> is_on_outline(mesh.vertex_count, 0);  // [V] those of them at which another edge is not shown
  for (uint32_t f : faces)
    for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
      if (choice.shown[mesh.edge[h]]) continue;
      for (uint32_t end : {mesh.origin[h], mesh.tip(h)}) is_on_outline[end] = has_wanted[end];
    }
  const auto is_kept_by_view = [&](uint32_t e) {
    return choice.split[e] == 0 && selection.is_kept_by_view(choice.level->mesh, choice.shown, e);
  };
  keep_if(faces, [&](uint32_t f) {
    const uint32_t* edge = &mesh.edge[size_t{3} * f];
    return touches(is_on_outline, f) && choice.may_divide(f) && std::any_of(edge, edge + 3, is_kept_by_view);
  });
  return faces;
}

}  // namespace

void add_faces_at_outline(LevelChoice& choice, const Selection& selection, Buffer<uint32_t>& red) {
  choice.at_outline = faces_at_outline(choice, selection);
  const Buffer<uint32_t> divided = std::move(red);
  red = Buffer<uint32_t>(divided.size() + choice.at_outline.size());
  std::ranges::merge(divided, choice.at_outline, red.begin());
}

void divide_at_outlines(std::span<LevelChoice> levels, double most_cosine) {
  for (size_t k = levels.size() - 1; k > 0; --k) {
    LevelChoice& above = levels[k - 1];
    const size_t before = above.split_edges.size();
    for (uint32_t f : above.at_outline)
      if (levels[k].splits_below(f))
        for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) above.split_edge(above.level->mesh.topology.edge[h]);
    if (above.split_edges.size() == before) return;
    avoid_slivers(above, most_cosine);
  }
}

}  // namespace papilio
