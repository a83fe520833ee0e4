#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>

namespace papilio {

/// `std::max` and `std::min` of numbers in unpredictable order, without a branch. Compilers of WebAssembly take them
/// for a `select`, of which V8 makes a branch; the instruction for vectors that is used there returns the same bits,
/// also where one is not a number.
#if defined(__wasm_simd128__)
[[nodiscard]] inline double larger(double a, double b) {
  using Two = double __attribute__((vector_size(16)));
  return __builtin_wasm_pmax_f64x2(Two{a, a}, Two{b, b})[0];
}
[[nodiscard]] inline double lesser(double a, double b) {
  using Two = double __attribute__((vector_size(16)));
  return __builtin_wasm_pmin_f64x2(Two{a, a}, Two{b, b})[0];
}
[[nodiscard]] inline float larger(float a, float b) {
  using Four = float __attribute__((vector_size(16)));
  return __builtin_wasm_pmax_f32x4(Four{a, a, a, a}, Four{b, b, b, b})[0];
}
[[nodiscard]] inline float lesser(float a, float b) {
  using Four = float __attribute__((vector_size(16)));
  return __builtin_wasm_pmin_f32x4(Four{a, a, a, a}, Four{b, b, b, b})[0];
}
/// `is_first ? a : b`.
[[nodiscard]] inline double either(bool is_first, double a, double b) {
  using Two = double __attribute__((vector_size(16)));
  using Bits = int64_t __attribute__((vector_size(16)));
  const int64_t mask = is_first ? -1 : 0;
  return (Bits{mask, mask} ? Two{a, a} : Two{b, b})[0];
}
#else
[[nodiscard]] inline double larger(double a, double b) { return std::max(a, b); }
[[nodiscard]] inline double lesser(double a, double b) { return std::min(a, b); }
[[nodiscard]] inline float larger(float a, float b) { return std::max(a, b); }
[[nodiscard]] inline float lesser(float a, float b) { return std::min(a, b); }
[[nodiscard]] inline double either(bool is_first, double a, double b) { return is_first ? a : b; }
#endif

/// Of several: from the left to the right, like `std::max` of a list.
template <std::floating_point Real, std::same_as<Real>... More>
[[nodiscard]] Real larger(Real a, Real b, Real c, More... more) {
  return larger(larger(a, b), c, more...);
}
template <std::floating_point Real, std::same_as<Real>... More>
[[nodiscard]] Real lesser(Real a, Real b, Real c, More... more) {
  return lesser(lesser(a, b), c, more...);
}

}  // namespace papilio
