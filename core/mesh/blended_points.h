#pragma once

#include <span>

#include "papilio/mesh.h"

namespace papilio {

/// The points of an input, and points whose attributes lie between those of two others.
class BlendedPoints {
 public:
  /// The input must outlive this.
  explicit BlendedPoints(const TriangleMesh& input) : input_(input) {}

  /// Returns a point whose attributes are `share` of the way from those of p to those of q: one of `known` if its
  /// values differ by rounding only, else a new one. Throws `Error` like `check_attributes`.
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
