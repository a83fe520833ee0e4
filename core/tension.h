#pragma once

#include <vector>

#include "mesh.h"

// Tension: no overshoot at sharp edges. The paper reduces stencil weights by factors t_i that it defers to another
// paper; the definition here is this project's own. The butterfly rule is the edge's midpoint less second differences
// over the hinges (edges between two faces) in its stencil; each difference is scaled by how flat its hinges are.

namespace papilio {

enum class Tension {
  soft,   ///< hinges sharper than 60 degrees count less, those of 90 and more not at all
  off,    ///< the plain Modified Butterfly scheme
  sharp,  ///< soft, and sharp edges themselves follow the four-point rule along the feature
};

/// How much a hinge counts, by the product of its two unit normals: 1 up to 60 degrees, 0 from 90 on, a smooth step
/// between.
[[nodiscard]] double hinge_factor(double normal_product);

/// New vertices keep within this share of their edge's length of its midpoint.
inline constexpr double tension_bound = 0.2;

/// Factor of each edge as a hinge, by the faces' normals [F]; 1 where a face has no normal, and on edges without two
/// faces. Shape [E].
[[nodiscard]] std::vector<float> hinge_factors(const Topology& mesh, const std::vector<Vec3f>& normals);

}  // namespace papilio
