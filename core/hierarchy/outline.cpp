#include "hierarchy/outline.h"

#include <algorithm>
#include <utility>

#include "hierarchy/transition.h"

namespace papilio {
namespace {

/// Finds the faces that add_faces_at_outline() adds.
Buffer<uint32_t> faces_at_outline(const LevelChoice& choice, int level, const Selection& selection) {
  const Topology& mesh = choice.level->mesh.topology;
  Buffer<uint8_t> has_candidate(mesh.vertex_count, 0);  // [V] at a candidate whose halves may be candidates
  for (EdgeId e : choice.candidates)
    if (const HalfEdgeId h = mesh.half_edge[e]; selection.may_have_long_halves(choice.level->mesh, e))
      has_candidate[mesh.origin[h]] = has_candidate[mesh.tip(h)] = 1;
  Buffer<uint32_t> faces = chosen(
      choice.region.faces, [&](FaceId f) { return choice.split_mask(f) != 7 && is_touched(mesh, has_candidate, f); });
  Buffer<uint8_t> is_on_outline(mesh.vertex_count, 0);  // [V] at such a candidate and at an edge that is not shown
  for (FaceId f : faces)
    for (HalfEdgeId h = 3 * f; h < 3 * f + 3; ++h) {
      if (choice.shown[mesh.edge[h]]) continue;
      for (uint32_t end : {mesh.origin[h], mesh.tip(h)}) is_on_outline[end] = has_candidate[end];
    }
  const auto is_kept_by_view = [&](EdgeId e) {
    return choice.split[e] == 0 && selection.is_kept_by_view(choice.level->mesh, choice.shown, e);
  };
  const Marks is_curved = selection.curved(choice.level->mesh, choice.level->trial, level, choice.region);
  keep_if(faces, [&](FaceId f) {
    const uint32_t* edge = &mesh.edge[size_t{3} * f];
    const bool may_divide = (is_curved[edge[0]] & is_curved[edge[1]] & is_curved[edge[2]]) != 0;
    return is_touched(mesh, is_on_outline, f) && may_divide && std::any_of(edge, edge + 3, is_kept_by_view);
  });
  return faces;
}

}  // namespace

void add_faces_at_outline(LevelChoice& choice, int level, const Selection& selection, Buffer<uint32_t>& red) {
  choice.at_outline = faces_at_outline(choice, level, selection);
  const Buffer<uint32_t> divided = std::move(red);
  red = Buffer<uint32_t>(divided.size() + choice.at_outline.size());
  std::ranges::merge(divided, choice.at_outline, red.begin());
}

void divide_at_outlines(std::span<LevelChoice> levels) {
  for (size_t k = levels.size() - 1; k > 0; --k) {
    LevelChoice& above = levels[k - 1];
    const size_t before = above.split_edges.size();
    for (FaceId f : above.at_outline)
      if (levels[k].splits_below(f)) above.divide(f);
    if (above.split_edges.size() == before) return;
    avoid_slivers(above);
  }
}

}  // namespace papilio
