#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "client/lib/surface_distance.h"
#include "papilio/mesh.h"

namespace papilio::test {

/// Two-sided distance of two surfaces: the larger of both directions, in percent of the original's diagonal.
struct SampledDistance {
  double rms = 0;
  double largest = 0;
};

/// Returns points on the triangles, each for an equal share of the area; none without area. Deterministic: strata in
/// the order of the triangles, Martin Roberts' R2 sequence (2018) inside of them.
[[nodiscard]] std::vector<Vec3d> sample_by_area(std::span<const TriangleCorners> triangles, size_t count);

/// Surface with its samples, for distances to other surfaces. It shares only the distance to one triangle with the
/// core.
class SampledSurface {
 public:
  static constexpr size_t default_samples = 60'000;

  /// The mesh must have an area and finite positions.
  explicit SampledSurface(const TriangleMesh& original, size_t samples = default_samples);

  /// Measures from the samples of each surface to the other. `other` must have triangles.
  [[nodiscard]] SampledDistance distance_to(const TriangleMesh& other) const;
  [[nodiscard]] double diagonal() const { return diagonal_; }

 private:
  std::vector<TriangleCorners> triangles_;
  client::SurfaceDistance tree_;
  std::vector<Vec3d> samples_;
  double diagonal_;
};

}  // namespace papilio::test
