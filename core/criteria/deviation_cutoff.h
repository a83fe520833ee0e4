#pragma once

namespace papilio {

/// The distance from its edge's middle, which is on the surface, up to which a new vertex cannot have the largest
/// deviation (deviation.h). Computed in floats, and low enough for that to be certain.
class DeviationCutoff {
 public:
  /// Of a mesh with no larger coordinate, whatever its sign.
  explicit DeviationCutoff(float largest_coordinate) : rounding_(share_that_rounds * largest_coordinate) {}

  /// Deviations below this one are not the largest.
  void raise(double deviation) {
    const double sure = deviation - rounding_;
    if (sure > least_sure) squared_ = static_cast<float>(sure * sure);
  }
  /// Its square; negative where every vertex is far enough.
  [[nodiscard]] float squared() const { return squared_; }

 private:
  /// Of the largest coordinate: more than floats make of the distance between two points of the mesh.
  static constexpr double share_that_rounds = 2e-6;
  static constexpr double least_sure = 1e-15;  ///< squares of smaller floats lose digits

  double rounding_;
  float squared_ = -1;
};

}  // namespace papilio
