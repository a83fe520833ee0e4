#pragma once

#include <cstddef>
#include <vector>

#include "hierarchy/prism.h"
#include "hierarchy/result_surface.h"

namespace papilio {

/// Point of the surface, and a piece of the result near it.
struct PointNear {
  Vec3d point;
  double squared;         ///< upper bound of the squared distance from the result; from the piece, if there is one
  uint32_t piece = none;  ///< number of the piece; `none` if it is not known
};

/// Pieces of the result near one leaf, an undivided face, after the other. Not thread-safe.
class NearPieces {
 public:
  /// The result must outlive this object.
  explicit NearPieces(ResultSurface& result) : result_(&result) {}

  /// Goes to another leaf; numbers of pieces are no longer valid.
  void go_to(const LevelFace& leaf);

  /// Returns the point with a piece around the leaf within the root of `enough`, or else with the nearest one.
  [[nodiscard]] PointNear near(Vec3d point, double enough);
  /// Returns the point with a piece of the leaf, or of those beside it, within the root of `enough`, if there is one.
  [[nodiscard]] PointNear beside(Vec3d point, double enough);
  [[nodiscard]] const Prism& prism(uint32_t piece) const { return prisms_[piece]; }

 private:
  void add_prisms(const LevelFace& leaf);

  ResultSurface* result_;
  LevelFace leaf_{};
  std::vector<Prism> prisms_;            ///< of the leaf, of those beside it, and of nearest ones, as far as needed
  bool has_beside_ = false;              ///< whether it has those beside the leaf
  std::vector<TriangleCorners> pieces_;  ///< member to reuse its memory, like the next
  std::vector<LevelFace> beside_;
};

}  // namespace papilio
