#include "hierarchy/patch.h"

#include "split/split_pattern.h"

namespace papilio {
namespace {

/// Sides of each child, as bits, that lie on the parent's side of equal number.
constexpr std::array<unsigned, 4> sides_of_child{0b101, 0b011, 0b110, 0};

}  // namespace

Patches patches_over(const Corners& corner, const Corners& middle, unsigned ridges) {
  const std::array<Corners, 4> children = children_of(corner, middle);
  Patches patches;
  for (uint32_t c = 0; c < 4; ++c) {
    patches[c].corner = children[c];
    patches[c].ridges = ridges & sides_of_child[c];
  }
  return patches;
}

void bend_along(Patches& patches, uint32_t corner, Vec3d from, Vec3d to) {
  patches[corner].bent_side = (corner + 1) % 3;
  patches[3].bent_side = (corner + 2) % 3;
  patches[corner].bend = patches[3].bend = middle_of(from, to);
}

Patches patches_below(const Patch& patch, const Corners& middle) {
  Patches below = patches_over(patch.corner, middle, patch.ridges);
  if (patch.bent_side != none) bend_along(below, (patch.bent_side + 2) % 3, patch.bend, patch.opposite_bend());
  return below;
}

Patches patches_over_leaf(const ResultSurface& result, const LevelFace& leaf, const LeafCorners& at) {
  const auto [k, f] = leaf;
  const auto& [corner, made, middle] = at;
  const unsigned mask = result.choice(k).split_mask(f);
  Patches below = patches_over(corner, middle, 0b111);
  const auto add_ridge_inside = [&](uint32_t child) { below[child].ridges |= 1U << inner_side[child]; };
  const uint32_t i = first_target[mask];
  const uint32_t opposite = (i + 2) % 3;
  if (mask == 7) {
    for (uint32_t child = 0; child < 3; ++child) add_ridge_inside(child);
  } else if (has_two_targets(mask)) {
    add_ridge_inside((i + 1) % 3);
    if (result.has_second_diagonal(k, f, mask))
      bend_along(below, opposite, made[i], corner[opposite]);
    else
      bend_along(below, i, made[(i + 1) % 3], corner[i]);
  } else if (mask != 0) {
    bend_along(below, opposite, made[i], corner[opposite]);
  }
  return below;
}

}  // namespace papilio
