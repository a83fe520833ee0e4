#pragma once

#include <array>
#include <limits>
#include <vector>

#include "hierarchy/result_surface.h"

namespace papilio {

/// Uniform surface, as far as the levels of a choice hold it: children of the deepest faces. Not thread-safe.
class LevelSurface {
 public:
  /// The result of the choice must outlive this object.
  explicit LevelSurface(const ResultSurface& result) : result_(&result) {}

  struct Nearest {
    double squared = std::numeric_limits<double>::infinity();  ///< squared distance
    Corners face{};
  };
  /// Returns the nearest face to a point around a face, or one within the root of `enough`. Visits neighbours while
  /// they are as near as any face so far. Where the surface is not explored as deep as at the face, the levels above
  /// represent it, up to `coarsest`.
  [[nodiscard]] Nearest nearest(LevelFace from, uint32_t coarsest, Vec3d point, double enough);

 private:
  [[nodiscard]] Nearest nearest_of_level(uint32_t k, FaceId f, Vec3d point, double enough);
  /// Returns the new face that a walk over the new faces ends at: above or below the point, unless the walk is long. It
  /// starts in the middle of a face, which has no children.
  [[nodiscard]] Nearest nearest_by_walk(uint32_t k, FaceId f, Vec3d point) const;
  /// Returns the nearest of the deepest descendants of a face below the point.
  [[nodiscard]] Nearest nearest_below(uint32_t k, FaceId f, Vec3d point, double enough) const;
  /// Returns the nearest of descendants found by a walk on each level: children may slide along the face until the
  /// point is above others.
  [[nodiscard]] Nearest nearest_where_it_slid(uint32_t k, FaceId f, Vec3d point, double enough) const;
  /// Returns the nearest new face of a face without children.
  [[nodiscard]] Nearest nearest_new_face(uint32_t k, FaceId f, Vec3d point, double enough) const;
  /// Walks over the faces of a level, each time across the side that lies most between, until the point is above one.
  [[nodiscard]] FaceId walk_towards(uint32_t k, FaceId f, Vec3d point) const;
  [[nodiscard]] std::array<Corners, 4> new_faces(uint32_t k, FaceId f) const;
  /// Returns the half-edge's twin, or none where the face across is not in the region.
  [[nodiscard]] uint32_t twin_in_region(uint32_t k, HalfEdgeId h) const;
  /// Returns the point's distance inside each side of a triangle, in one unit: the weight of the opposite corner.
  [[nodiscard]] static std::array<double, 3> weights_in(const Corners& corner, Vec3d point);
  /// Returns the child of a face below the point: the one at a corner with more than half of the weight, or the middle
  /// one.
  [[nodiscard]] uint32_t child_below(uint32_t k, FaceId f, Vec3d point) const;

  const ResultSurface* result_;
  std::vector<uint32_t> visited_;  ///< member to reuse its memory
};

}  // namespace papilio
