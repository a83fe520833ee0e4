#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/doubled.h"

namespace papilio {

/// Returns the root of x^2 + y^2, without intermediate overflow or underflow. Bit-identical on every processor, by
/// + - x / and square roots alone. The error is below 0.51 units in the last place.
[[nodiscard]] inline double hypotenuse(double x, double y) {
  constexpr double large = 0x1p400;
  constexpr double small = 0x1p-400;
  double longer = std::max(std::abs(x), std::abs(y));
  if (longer == 0 || !(longer <= std::numeric_limits<double>::max())) return longer;
  const double scale = longer > large ? 0x1p-700 : longer < small ? 0x1p700 : 1;
  longer *= scale;
  const double shorter = scale * std::min(std::abs(x), std::abs(y));
  const double root = std::sqrt(longer * longer + shorter * shorter);
  if (shorter < 0x1p-60 * longer) return longer / scale;
  const Doubled a = exact_product(longer, longer);
  const Doubled b = exact_product(shorter, shorter);
  const Doubled c = exact_product(root, root);
  const double missing = ((a.high - c.high) + b.high) + ((a.low - c.low) + b.low);
  return (root + 0.5 * missing / root) / scale;
}

}  // namespace papilio
