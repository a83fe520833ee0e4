#pragma once

#include <optional>

#include "mesh/curve.h"
#include "papilio/mesh.h"
#include "papilio/options.h"
#include "rules/shape_rules.h"

// Tension: no overshoot at sharp edges. The paper lowers stencil weights by factors t_i of another paper, which cannot
// be found; the definition here is this project's own. A butterfly rule is the edge's midpoint minus second differences
// over the hinges (edges between two faces) of its stencil. Each difference is scaled by the flatness of the hinges
// between it and the edge.

namespace papilio {

/// Returns the factor of a hinge, given the product of its two unit normals: 1 up to 60 degrees, 0 from 90 on, a smooth
/// step between.
[[nodiscard]] double hinge_factor(double normal_product);

/// Bound of the distance from a new vertex to the midpoint, as a share of its edge's length.
inline constexpr double tension_bound = 0.2;

/// Tension values of one level.
struct TensionField {
  Buffer<float> factor;  ///< [E] the edge's factor as a hinge; 1 unless it has two faces with normals
  bool follow_features = false;
  VertexDegrees features{};           ///< with `follow_features`: counts of sharp edges (factor < 1/2)
  std::optional<ShapeField> shape{};  ///< where the mesh has shape rules

  [[nodiscard]] bool is_sharp(EdgeId e) const { return factor[e] < 0.5F; }
};

/// Computes the field of a level; `normals` [F] are those of its faces. O(V + E).
[[nodiscard]] TensionField tension_field(const Mesh& mesh, const Buffer<Vec3f>& normals, Tension tension);

}  // namespace papilio
