#pragma once

#include <cmath>
#include <limits>

namespace papilio::test {

/// Returns the error of a result in units in the last place of the exact value.
inline double error_in_units(double found, long double exact) {
  const double size = std::abs(static_cast<double>(exact));
  const double unit = std::nextafter(size, std::numeric_limits<double>::infinity()) - size;
  return static_cast<double>(std::abs(found - exact) / unit);
}

}  // namespace papilio::test
