#pragma once

#include "papilio/mesh.h"
#include "papilio/view.h"

namespace papilio::test {

/// The largest distances between an adaptive result and the uniform one of the same levels, of what a view shows, in
/// pixels of its picture.
struct SeenDistance {
  double to_adaptive = 0;  ///< from a sample of the uniform result to the adaptive one
  double to_uniform = 0;   ///< from a sample of the adaptive result to the uniform one
  [[nodiscard]] double largest() const { return to_adaptive > to_uniform ? to_adaptive : to_uniform; }
};

/// Measures with a tree of boxes. What is turned to the viewer and inside of the picture counts as seen, also where
/// something else covers it; a distance is as large as it looks there, whichever way it goes. Each face is sampled.
[[nodiscard]] SeenDistance seen_distance(const Mesh& adaptive, const Mesh& uniform, const View& view);

}  // namespace papilio::test
