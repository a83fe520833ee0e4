#pragma once

#include <optional>
#include <vector>

#include "criteria/camera.h"
#include "criteria/view_culling.h"
#include "mesh/split_plan.h"
#include "papilio/mesh.h"

// How far the surface would move where an edge is split: what geometric tolerance and budgets go by.

namespace papilio {

[[nodiscard]] inline Vec3d midpoint(const Mesh& mesh, uint32_t edge) {
  const uint32_t h = mesh.topology.half_edge[edge];
  return 0.5 * (to_double(mesh.positions[mesh.topology.origin[h]]) + to_double(mesh.positions[mesh.topology.tip(h)]));
}

/// Squared distance from q to the middle of the segment from a to b.
[[nodiscard]] inline double squared_distance_to_middle(Vec3f q, Vec3f a, Vec3f b) {
  const Vec3d off = to_double(q) - 0.5 * (to_double(a) + to_double(b));
  return dot(off, off);
}

/// Distance from the edge's new vertex q to the surface as it is there: to the nearer of the edge's faces; on a curve
/// (boundary, shared, crease) to the edge itself. A vertex that slides inside a flat face does not move the surface.
/// In the mesh's unit. The edge's middle is on the surface: the distance to it is an upper bound, in spite of rounding.
[[nodiscard]] double deviation(const Mesh& mesh, uint32_t edge, Vec3f q);

/// That of a smooth edge from a to b, from the apexes of its two faces, the one on its left first. The same to the bit
/// where a is the vertex with the lower number.
[[nodiscard]] double deviation_from_faces(Vec3f q, Vec3f a, Vec3f b, Vec3f apex, Vec3f other_apex);

/// Turns deviations into the one number by which edges are compared, with the threshold that makes one a target.
class ErrorMeasure {
 public:
  /// `tolerance` as a share of `diagonal`, `view` and its `camera` (null: none) with its error_pixels and lights. Where
  /// both are given, the number is the lesser of the two shares that the deviation is of what is tolerated; where
  /// neither is, pixels with a view, else the share of the diagonal. Lights weigh pixels only.
  ErrorMeasure(double tolerance, double diagonal, const View* view, const Camera* camera);

  [[nodiscard]] float threshold() const { return threshold_; }
  /// The number, for a deviation at the edge. `normals` [F].
  [[nodiscard]] float error(const Mesh& mesh, const Buffer<Vec3f>& normals, uint32_t edge, double distance) const;
  /// No less than the error of an edge with no more than this deviation, where nothing is seen larger than at `scale`
  /// pixels a unit. What lights make of it is not bounded: infinite with them.
  [[nodiscard]] float most_error(double distance, double scale) const;
  /// A deviation below this has an error below `error`, on the same condition.
  [[nodiscard]] double least_deviation(float error, double scale) const;
  /// Whether of two deviations at an edge the larger never has the lesser error: what lights make of one is not known.
  [[nodiscard]] bool grows_with_distance() const { return view_ == nullptr || view_->lights.empty(); }
  /// The deviation in pixels of the view; 0 without one.
  [[nodiscard]] double pixels(const Mesh& mesh, uint32_t edge, double distance) const {
    return camera_ == nullptr ? 0 : distance * camera_->pixels_per_unit(midpoint(mesh, edge));
  }
  [[nodiscard]] double diagonal() const { return diagonal_; }

 private:
  double diagonal_;
  double tolerated_ = 0;         ///< distance; 0: not asked
  double tolerated_pixels_ = 0;  ///< 0: not asked
  const View* view_;
  const Camera* camera_;
  float threshold_ = 0;
};

}  // namespace papilio
