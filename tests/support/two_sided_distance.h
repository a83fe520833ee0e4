#pragma once

#include <array>
#include <vector>

#include "papilio/mesh.h"
#include "papilio/triangle_distance.h"

namespace papilio::test {

/// Returns the corners of each face.
[[nodiscard]] std::vector<TriangleCorners> corners_of(const Mesh& mesh);
/// Returns a face's corners, the quarters of its sides and inner points between these.
[[nodiscard]] std::array<Vec3d, 15> samples_of(const TriangleCorners& face);

/// Largest distances between an adaptive result and the uniform result of equal levels, in the mesh's unit.
struct TwoSidedDistance {
  double to_adaptive = 0;  ///< from a vertex of the uniform result to the adaptive surface
  double to_uniform = 0;   ///< from a sample of the adaptive surface to the uniform one
  double rms = 0;          ///< root mean square of the distances to the adaptive surface
  [[nodiscard]] double largest() const { return to_adaptive > to_uniform ? to_adaptive : to_uniform; }
};

/// Measures with a tree of boxes, which shares only the distance to one triangle with the core. Each adaptive face is
/// sampled.
[[nodiscard]] TwoSidedDistance two_sided_distance(const Mesh& adaptive, const Mesh& uniform);

}  // namespace papilio::test
