#pragma once

namespace papilio {

/// Cutoff of the distance from a new vertex to its edge's middle: up to it, the vertex cannot have the largest
/// deviation (deviation.h). Conservative for distances in floats.
class DeviationCutoff {
 public:
  /// Starts without a cutoff. `largest_coordinate` is an upper bound of the magnitudes in the mesh.
  explicit DeviationCutoff(float largest_coordinate) : rounding_(share_that_rounds * largest_coordinate) {}

  /// Raises the largest deviation found so far.
  void raise(double deviation) {
    const double sure = deviation - rounding_;
    if (sure > least_sure) squared_ = static_cast<float>(sure * sure);
  }
  /// Returns the squared cutoff; negative if no vertex can be skipped.
  [[nodiscard]] float squared() const { return squared_; }

 private:
  /// Bound of the rounding error of a distance in floats, a share of the largest coordinate.
  static constexpr double share_that_rounds = 2e-6;
  static constexpr double least_sure = 1e-15;  ///< lower bound of distances: squares of smaller floats lose digits

  double rounding_;
  float squared_ = -1;
};

}  // namespace papilio
