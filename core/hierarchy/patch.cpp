#include "hierarchy/patch.h"

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

}  // namespace papilio
