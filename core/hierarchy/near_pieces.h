#pragma once

#include <vector>

#include "hierarchy/prism.h"
#include "hierarchy/result_surface.h"

namespace papilio {

/// Point of the surface, and a piece of the result near it.
struct PointNear {
  Vec3d point;
  double squared;          ///< upper bound of the squared distance from the result; from the piece, if there is one
  bool has_piece = false;  ///< whether the piece is known
  TriangleCorners piece{};
};

/// Pieces of the result near one leaf, an undivided face, after the other. Not thread-safe.
class NearPieces {
 public:
  /// The result must outlive this object.
  explicit NearPieces(ResultSurface& result) : result_(&result) {}

  void go_to(const LevelFace& leaf);

  /// Returns the point with a piece around the leaf within the root of `enough`, or else with the nearest one.
  [[nodiscard]] PointNear near(Vec3d point, double enough);
  /// Returns the point with a piece that it is above or below, within the root of `enough`, if there is one.
  [[nodiscard]] PointNear above(Vec3d point, double enough);

 private:
  void add_prisms(const LevelFace& leaf);

  ResultSurface* result_;
  LevelFace leaf_{};
  std::vector<Prism> prisms_;            ///< of the leaf and of those beside it; empty until they are used
  std::vector<TriangleCorners> pieces_;  ///< member to reuse its memory, like the next
  std::vector<LevelFace> beside_;
};

/// Returns whether a piece is within the root of `enough` of the point.
[[nodiscard]] bool is_near(const TriangleCorners& piece, const PointNear& point, double enough);

}  // namespace papilio
