#pragma once

#include <vector>

#include "hierarchy/prisms.h"
#include "hierarchy/result_surface.h"

namespace papilio {

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
  [[nodiscard]] const Prisms& prisms() const { return prisms_; }

 private:
  void add_prisms(const LevelFace& leaf);

  ResultSurface* result_;
  LevelFace leaf_{};
  Prisms prisms_;                        ///< of the leaf, of those beside it, and of nearest ones, as far as needed
  bool has_beside_ = false;              ///< whether it has those beside the leaf
  std::vector<TriangleCorners> pieces_;  ///< member to reuse its memory, like the next
  std::vector<LevelFace> beside_;
};

}  // namespace papilio
