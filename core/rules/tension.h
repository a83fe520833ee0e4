#pragma once

#include <optional>

#include "mesh/curve.h"
#include "papilio/mesh.h"
#include "papilio/options.h"
#include "rules/shape_rules.h"

// Tension: no overshoot at sharp edges. The paper lowers stencil weights by factors t_i that it takes from another
// paper, which cannot be found; the definition here is this project's own. A butterfly rule is the edge's midpoint less
// second differences over the hinges (edges between two faces) of its stencil; each difference is scaled by how flat
// the hinges are that lie between it and the edge.

namespace papilio {

/// How much a hinge counts, by the product of its two unit normals: 1 up to 60 degrees, 0 from 90 on, a smooth step
/// between.
[[nodiscard]] double hinge_factor(double normal_product);

/// A new vertex stays within this share of its edge's length of the midpoint.
inline constexpr double tension_bound = 0.2;

/// What tension makes of one level.
struct TensionField {
  Buffer<float> factor;  ///< [E] the edge's factor as a hinge; 1 where it has not two faces with normals
  bool follow_features = false;
  VertexDegrees features{};           ///< with `follow_features`: of the sharp edges (factor under 1/2)
  std::optional<ShapeField> shape{};  ///< where the mesh has shape rules

  [[nodiscard]] bool is_sharp(uint32_t e) const { return factor[e] < 0.5F; }
};

/// The field of a level; `normals` [F] are its faces'. O(V + E).
[[nodiscard]] TensionField tension_field(const Mesh& mesh, const Buffer<Vec3f>& normals, Tension tension);

}  // namespace papilio
