#pragma once

#include <array>
#include <vector>

#include "hierarchy/result_surface.h"

namespace papilio {

/// The uniform surface, as far as the levels of a choice hold it: the new faces of the deepest ones. Not for threads to
/// share.
class LevelSurface {
 public:
  /// The result of the choice must outlive this.
  explicit LevelSurface(const ResultSurface& result) : result_(&result) {}

  /// The distance, squared, from a point to the surface round a face: visits others as long as they are as near as any
  /// so far, and the distance is above `enough`. Where the surface was not explored as deep as there, the levels above
  /// stand for it, up to `coarsest`.
  [[nodiscard]] double squared_distance(LevelFace from, uint32_t coarsest, Vec3d point, double enough);

 private:
  [[nodiscard]] double squared_distance_to_level(uint32_t k, uint32_t f, Vec3d point, double enough);
  /// Of a face below which others are held, to the deepest ones below the point.
  [[nodiscard]] double squared_distance_to_children(uint32_t k, uint32_t f, Vec3d point, double enough) const;
  /// The same by walking on each level: children may slide along the face until the point is above others.
  [[nodiscard]] double squared_distance_where_it_slid(uint32_t k, uint32_t f, Vec3d point, double enough) const;
  /// Of a face below which none is held.
  [[nodiscard]] double squared_distance_to_new_faces(uint32_t k, uint32_t f, Vec3d point, double enough) const;
  /// Faces beyond may be held for other requests, or not.
  [[nodiscard]] uint32_t twin_in_region(uint32_t k, uint32_t h) const;
  /// Walks over the faces of a level, each time across the side that lies most between, until the point is above one.
  [[nodiscard]] uint32_t walk_towards(uint32_t k, uint32_t f, Vec3d point) const;
  /// How far inside of each side the point is above a face, in one unit: the weight of the opposite corner.
  [[nodiscard]] std::array<double, 3> weights_in(uint32_t k, uint32_t f, Vec3d point) const;
  /// The child of a face that is below the point: at a corner with more than half of the weight, or in the middle.
  [[nodiscard]] uint32_t child_below(uint32_t k, uint32_t f, Vec3d point) const;

  const ResultSurface* result_;
  std::vector<uint32_t> visited_;  ///< kept for its memory
};

}  // namespace papilio
