#pragma once

#include <span>
#include <vector>

#include "hierarchy/prism.h"
#include "hierarchy/result_surface.h"

namespace papilio {

/// Pieces of the result near one leaf, an undivided face, after the other. Not thread-safe.
class NearPieces {
 public:
  /// The result must outlive this object.
  explicit NearPieces(ResultSurface& result) : result_(&result) {}

  void go_to(const LevelFace& leaf);

  /// Returns whether a point is above or below a piece of the leaf, no further than the root of `squared`.
  [[nodiscard]] bool has_near(Vec3d point, double squared);
  /// Returns a piece around the leaf within the root of `enough` of a point, or else the nearest one. Sets `squared` to
  /// at least the squared distance from it where that exceeds `enough`.
  [[nodiscard]] TriangleCorners near(Vec3d point, double enough, double& squared);
  /// Returns whether a piece of the leaf is within the root of `enough` of all points, and so of all between them.
  [[nodiscard]] bool has_near_all(std::span<const Vec3d> points, double enough);

 private:
  [[nodiscard]] std::span<const TriangleCorners> pieces();
  [[nodiscard]] std::span<const Prism> prisms();

  ResultSurface* result_;
  LevelFace leaf_{};
  std::vector<TriangleCorners> pieces_;  ///< of the leaf; empty until they are used
  std::vector<Prism> prisms_;            ///< of `pieces_`; likewise
};

/// Returns whether a piece is within the root of `enough` of all points.
[[nodiscard]] bool is_near_all(const TriangleCorners& piece, std::span<const Vec3d> points, double enough);

}  // namespace papilio
