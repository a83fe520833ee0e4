#pragma once

#include <limits>
#include <span>
#include <vector>

#include "hierarchy/result_surface.h"

namespace papilio {

/// Upper bound of the distance between a result and the uniform surface.
struct DistanceLimit {
  double everywhere;               ///< in the mesh's unit
  const Camera* camera = nullptr;  ///< null: none
  double pixels = 0;               ///< with a camera, the bound in pixels, where that is the larger one

  /// Returns the bound at each face [F] of the choice's region, in the mesh's unit. It is infinite where the picture
  /// shows neither the face nor its pieces nor its descendants, whose normals are assumed to be within three times the
  /// turn of its children's.
  [[nodiscard]] Buffer<float> at_faces(const LevelChoice& choice) const;
};

/// Upper bounds of the distance at the faces of all levels. A face has the least bound of its descendants.
class AllowedDistance {
 public:
  static constexpr double any = std::numeric_limits<double>::infinity();

  /// Without a camera.
  explicit AllowedDistance(double everywhere) : least_(everywhere) {}
  AllowedDistance(std::span<const LevelChoice> levels, const DistanceLimit& limit);

  /// In the mesh's unit, or `any`.
  [[nodiscard]] double at(const LevelFace& face) const { return at_.empty() ? least_ : at_[face.level][face.face]; }
  [[nodiscard]] double least() const { return least_; }

 private:
  std::vector<Buffer<float>> at_;  ///< [level][F]; empty without a camera
  double least_;
};

}  // namespace papilio
