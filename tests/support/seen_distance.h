#pragma once

#include "papilio/mesh.h"
#include "papilio/view.h"

namespace papilio::test {

/// Largest visible distances in a view between an adaptive result and the uniform result of equal levels, in pixels.
struct SeenDistance {
  double to_adaptive = 0;  ///< from a sample of the uniform result to the adaptive one
  double to_uniform = 0;   ///< from a sample of the adaptive result to the uniform one
  [[nodiscard]] double largest() const { return to_adaptive > to_uniform ? to_adaptive : to_uniform; }
};

/// Measures with a tree of boxes. Front faces inside of the picture count as visible, even if occluded. Distances are
/// scaled to pixels at their position, in any direction. Each face is sampled.
[[nodiscard]] SeenDistance seen_distance(const Mesh& adaptive, const Mesh& uniform, const View& view);

}  // namespace papilio::test
