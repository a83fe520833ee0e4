#pragma once

#include <span>

#include "papilio/mesh.h"

namespace papilio {

/// Points of an input, and new points with attributes interpolated between two of them.
class BlendedPoints {
 public:
  /// Starts with the input's points. The input must outlive this.
  explicit BlendedPoints(const TriangleMesh& input) : input_(input) {}

  /// Returns a point with the attributes of p and q blended in the ratio 1 - share to share. It is one of `known` if
  /// its values differ by rounding only, else a new one. Throws as check_attributes().
  uint32_t between(uint32_t p, uint32_t q, double share, std::span<const uint32_t> known);

  /// Returns the input with the new points. Their positions are unset.
  [[nodiscard]] const TriangleMesh& mesh() const { return is_extended_ ? extended_ : input_; }

 private:
  void extend();

  const TriangleMesh& input_;
  TriangleMesh extended_;
  bool is_extended_ = false;
};

}  // namespace papilio
