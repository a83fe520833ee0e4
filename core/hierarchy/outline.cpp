#include "hierarchy/outline.h"

#include <algorithm>
#include <utility>

#include "hierarchy/transition.h"

namespace papilio {
namespace {

class Outline {
 public:
  Outline(const LevelChoice& choice, const Selection& selection)
      : choice_(choice), selection_(selection), mesh_(choice.level->mesh.topology) {}

  Buffer<uint32_t> faces() {
    find_wanted();
    Buffer<uint32_t> faces = choice_.region.faces;
    keep_if(faces, [&](uint32_t f) { return choice_.split_mask(f) != 7 && touches(has_wanted_, f); });
    find_outline(faces);
    keep_if(faces,
            [&](uint32_t f) { return touches(is_on_outline_, f) && choice_.may_divide(f) && is_kept_by_view(f); });
    return faces;
  }

 private:
  void find_wanted() {
    has_wanted_.assign(mesh_.vertex_count, 0);
    for (uint32_t e : choice_.candidates)
      if (const uint32_t h = mesh_.half_edge[e]; selection_.may_have_long_halves(choice_.level->mesh, e))
        has_wanted_[mesh_.origin[h]] = has_wanted_[mesh_.tip(h)] = 1;
  }

  [[nodiscard]] bool touches(const Buffer<uint8_t>& vertices, uint32_t f) const {
    const uint32_t* corner = &mesh_.origin[size_t{3} * f];
    return (vertices[corner[0]] | vertices[corner[1]] | vertices[corner[2]]) != 0;
  }

  void find_outline(const Buffer<uint32_t>& faces) {
    is_on_outline_.assign(mesh_.vertex_count, 0);
    for (uint32_t f : faces)
      for (uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
        if (choice_.shown[mesh_.edge[h]]) continue;
        for (uint32_t end : {mesh_.origin[h], mesh_.tip(h)}) is_on_outline_[end] = has_wanted_[end];
      }
  }

  [[nodiscard]] bool is_kept_by_view(uint32_t f) const {
    const uint32_t* edge = &mesh_.edge[size_t{3} * f];
    return std::any_of(edge, edge + 3, [&](uint32_t e) {
      return choice_.split[e] == 0 && selection_.is_kept_by_view(choice_.level->mesh, choice_.shown, e);
    });
  }

  const LevelChoice& choice_;
  const Selection& selection_;
  const Topology& mesh_;
  Buffer<uint8_t> has_wanted_;     ///< [V] at which an edge is wanted whose halves may be
  Buffer<uint8_t> is_on_outline_;  ///< [V] those of them at which another edge is not shown
};

}  // namespace

void add_faces_at_outline(LevelChoice& choice, const Selection& selection, Buffer<uint32_t>& red) {
  choice.at_outline = Outline(choice, selection).faces();
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
