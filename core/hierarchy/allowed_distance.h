#pragma once

#include <limits>
#include <span>
#include <vector>

#include "hierarchy/result_surface.h"

namespace papilio {

/// How far a result may be from the uniform surface: everywhere alike, or so many pixels of a picture.
struct DistanceLimit {
  double everywhere;               ///< in the mesh's unit
  const Camera* camera = nullptr;  ///< null: none
  double pixels = 0;               ///< with a camera: further where this is less than so many

  /// [F] of the choice's region, in the mesh's unit. Infinite where the picture shows neither the face nor its pieces,
  /// nor what lies below, whose normals are taken to be within three times the turn of its children's.
  [[nodiscard]] Buffer<float> at_faces(const LevelChoice& choice) const;
};

/// The same at the faces of all levels. What a face below has, has the face above.
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
