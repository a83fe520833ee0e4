#pragma once

#include <optional>
#include <vector>

#include "criteria/camera.h"
#include "criteria/view_culling.h"
#include "mesh/marks.h"
#include "papilio/mesh.h"

// Deviation: the distance by which the surface moves when an edge is split. Tolerances and budgets compare it.

namespace papilio {

[[nodiscard]] inline Vec3d midpoint(const Mesh& mesh, EdgeId edge) {
  const HalfEdgeId h = mesh.topology.half_edge[edge];
  return 0.5 * (to_double(mesh.positions[mesh.topology.origin[h]]) + to_double(mesh.positions[mesh.topology.tip(h)]));
}

/// Returns the squared distance from q to the middle of the segment from a to b.
[[nodiscard]] inline double squared_distance_to_middle(Vec3f q, Vec3f a, Vec3f b) {
  const Vec3d off = to_double(q) - 0.5 * (to_double(a) + to_double(b));
  return dot(off, off);
}

/// Returns the distance from the edge's new vertex q to the present surface, in the mesh's unit: to the nearer of the
/// edge's faces, or on a curve (boundary, shared, crease) to the edge. A vertex that slides inside a flat face does not
/// move the surface. The distance to the edge's middle is an upper bound, in spite of rounding.
[[nodiscard]] double deviation(const Mesh& mesh, EdgeId edge, Vec3f q);

/// Returns the deviation of a smooth edge from a to b, given the apexes of its left and its right face. Bit-identical
/// to deviation() if a is the vertex with the lower number.
[[nodiscard]] double deviation_from_faces(Vec3f q, Vec3f a, Vec3f b, Vec3f apex, Vec3f other_apex);

/// Error of an edge, the number by which edges are compared, from its deviation; and the lower bound at which an edge
/// is split.
class ErrorMeasure {
 public:
  /// Measures by `tolerance`, a share of `diagonal`, and by error_pixels and lights of `view` with its `camera`, or
  /// null. With both bounds, the error is the lesser ratio of the deviation to its bound. With neither, it is in pixels
  /// of the view, or else a share of the diagonal. Lights weight pixels only.
  ErrorMeasure(double tolerance, double diagonal, const View* view, const Camera* camera);

  [[nodiscard]] float threshold() const { return threshold_; }
  /// Returns the error of a deviation at the edge. `normals` [F].
  [[nodiscard]] float error(const Mesh& mesh, const Buffer<Vec3f>& normals, EdgeId edge, double distance) const;
  /// Returns a lower bound of the deviations whose error reaches `error`, at most `scale` pixels per unit.
  [[nodiscard]] double least_deviation(float error, double scale) const;
  /// Returns whether the error is monotonic in the deviation at an edge. Not guaranteed with lights.
  [[nodiscard]] bool grows_with_distance() const { return view_ == nullptr || view_->lights.empty(); }
  /// Returns the deviation in pixels of the view; 0 without a view.
  [[nodiscard]] double pixels(const Mesh& mesh, EdgeId edge, double distance) const {
    return camera_ == nullptr ? 0 : distance * camera_->pixels_per_unit(midpoint(mesh, edge));
  }
  [[nodiscard]] double diagonal() const { return diagonal_; }

 private:
  double diagonal_;
  double tolerated_ = 0;         ///< upper bound of the distance; 0: no bound
  double tolerated_pixels_ = 0;  ///< upper bound in pixels; 0: no bound
  const View* view_;
  const Camera* camera_;
  float threshold_ = 0;
};

}  // namespace papilio
