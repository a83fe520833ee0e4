#pragma once

namespace papilio {

// Exact sums and products, by + - x / alone. Sources: [K] Knuth, "The art of computer programming"
// 4.2.2; [D] Dekker, "A floating-point technique for extending the available precision", 1971.

/// Number of about 106 bits: the unevaluated sum of two, of which the first is the sum rounded.
struct Doubled {
  double high = 0, low = 0;
};

/// Returns the exact sum of two numbers, where |larger| >= |smaller| [D].
[[nodiscard]] constexpr Doubled sum_to_larger(double larger, double smaller) {
  const double sum = larger + smaller;
  return {sum, smaller - (sum - larger)};
}

/// Returns the exact sum of any two numbers [K].
[[nodiscard]] constexpr Doubled exact_sum(double a, double b) {
  const double sum = a + b;
  const double b_in_sum = sum - a;
  return {sum, (a - (sum - b_in_sum)) + (b - b_in_sum)};
}

/// Returns the exact product of two numbers, each 0 or of a magnitude in 1e-140..1e140 [D].
[[nodiscard]] constexpr Doubled exact_product(double a, double b) {
  constexpr double splitter = 134217729;  // 2^27 + 1: splits 53 bits in two halves
  const auto upper_half = [](double x) {
    const double scaled = splitter * x;
    return scaled - (scaled - x);
  };
  const double a_high = upper_half(a);
  const double b_high = upper_half(b);
  const double a_low = a - a_high;
  const double b_low = b - b_high;
  const double product = a * b;
  return {product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

[[nodiscard]] constexpr Doubled operator*(Doubled a, Doubled b) {
  const Doubled product = exact_product(a.high, b.high);
  return sum_to_larger(product.high, product.low + (a.high * b.low + a.low * b.high));
}

[[nodiscard]] constexpr Doubled operator/(Doubled a, Doubled b) {
  const double quotient = a.high / b.high;
  const Doubled product = exact_product(quotient, b.high);
  const double left = ((a.high - product.high) - product.low) + (a.low - quotient * b.low);
  return sum_to_larger(quotient, left / b.high);
}

}  // namespace papilio
