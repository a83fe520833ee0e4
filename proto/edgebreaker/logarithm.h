#pragma once

#include <cmath>

namespace papilio::proto::edgebreaker {

/// Returns the logarithm to base 2 of a positive number. Bit-identical on every processor, by + - x / alone. The error
/// is below 3 units in the last place.
[[nodiscard]] inline double logarithm_to_base_2(double x) {
  constexpr double root_of_half = 0.70710678118654752;
  constexpr double twice_per_e = 2.8853900817779268;  // 2 / log(2)
  constexpr int terms = 11;
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  if (mantissa < root_of_half) {
    mantissa *= 2;
    --exponent;
  }
  // log(m) = 2 artanh(s), whose power series has the terms s^(2i + 1) / (2i + 1).
  const double s = (mantissa - 1) / (mantissa + 1);
  const double square = s * s;
  double sum = 0;
  for (int i = terms - 1; i > 0; --i) sum = (sum + 1.0 / (2 * i + 1)) * square;
  return exponent + twice_per_e * (s + s * sum);
}

}  // namespace papilio::proto::edgebreaker
