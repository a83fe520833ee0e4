#pragma once

namespace papilio {

// Sums and products without rounding errors, of + - x / alone. Sources: [K] Knuth, "The art of computer programming"
// 4.2.2; [D] Dekker, "A floating-point technique for extending the available precision", 1971.

/// A number of about 106 bits: the sum of two, of which the first is the sum rounded.
struct Doubled {
  double high = 0, low = 0;
};

/// The sum of the two, where the first is not the smaller, whatever their signs [D].
[[nodiscard]] constexpr Doubled sum_to_larger(double larger, double smaller) {
  const double sum = larger + smaller;
  return {sum, smaller - (sum - larger)};
}

/// The sum of any two [K].
[[nodiscard]] constexpr Doubled exact_sum(double a, double b) {
  const double sum = a + b;
  const double b_in_sum = sum - a;
  return {sum, (a - (sum - b_in_sum)) + (b - b_in_sum)};
}

/// The product of two between 1e-140 and 1e140, whatever their signs, or of 0 [D].
[[nodiscard]] constexpr Doubled exact_product(double a, double b) {
  constexpr double splitter = 134217729;  // 2^27 + 1: cuts 53 bits in two
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
