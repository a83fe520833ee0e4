#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "papilio/buffer.h"
#include "papilio/vec3.h"
#include "simd/vec3fa.h"

namespace papilio {

/// Four floats in a register, for four computations at once. For bounds with a margin for rounding: results proper are
/// not made of it.
using Float4 = Vec3fa::Register;
using Mask4 = int32_t __attribute__((vector_size(16)));  ///< of comparisons: all set where true, else none
using Index4 = std::array<uint32_t, 4>;

[[nodiscard]] inline Float4 lesser(Float4 a, Float4 b) { return a < b ? a : b; }
[[nodiscard]] inline Float4 larger(Float4 a, Float4 b) { return a > b ? a : b; }
[[nodiscard]] inline Float4 magnitude(Float4 a) { return larger(a, -a); }
[[nodiscard]] inline Float4 root(Float4 a) {
  return Float4{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};  // of which compilers make one
}

struct Vec3x4 {
  Float4 x, y, z;

  friend Vec3x4 operator-(const Vec3x4& a, const Vec3x4& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3x4 operator*(float s, const Vec3x4& a) { return {s * a.x, s * a.y, s * a.z}; }
};

[[nodiscard]] inline Float4 dot(const Vec3x4& a, const Vec3x4& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
[[nodiscard]] inline Vec3x4 cross(const Vec3x4& a, const Vec3x4& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// One of the four vectors, four times.
template <int which>
[[nodiscard]] inline Vec3x4 splat(const Vec3x4& a) {
  return {__builtin_shufflevector(a.x, a.x, which, which, which, which),
          __builtin_shufflevector(a.y, a.y, which, which, which, which),
          __builtin_shufflevector(a.z, a.z, which, which, which, which)};
}
/// No less than the length.
[[nodiscard]] inline Float4 sum_of_magnitudes(const Vec3x4& a) {
  return magnitude(a.x) + magnitude(a.y) + magnitude(a.z);
}

/// Four vectors, one beside the other.
[[nodiscard]] inline Vec3x4 transposed(Vec3fa one, Vec3fa two, Vec3fa three, Vec3fa four) {
  const auto [a, b, c, d] = std::array<Float4, 4>{one.v, two.v, three.v, four.v};
  const Float4 ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const Float4 cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Float4 ab_behind = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Float4 cd_behind = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  return {__builtin_shufflevector(ab, cd, 0, 1, 4, 5), __builtin_shufflevector(ab, cd, 2, 3, 6, 7),
          __builtin_shufflevector(ab_behind, cd_behind, 0, 1, 4, 5)};
}

/// Of an array that has room for one behind its end (vec3fa.h).
[[nodiscard]] inline Vec3x4 at(const Vec3f* points, const Index4& numbers) {
  return transposed(widen(points[numbers[0]]), widen(points[numbers[1]]), widen(points[numbers[2]]),
                    widen(points[numbers[3]]));
}
[[nodiscard]] inline Vec3x4 at(const Buffer<Vec3f>& points, const Index4& numbers) {
  return at(points.data(), numbers);
}

/// True where the fourth power of a length, given squared, is surely a number that has all its digits.
[[nodiscard]] inline Mask4 is_usual(Float4 length_squared) {
  return (length_squared > 1e-14F) & (length_squared < 1e16F);
}

}  // namespace papilio
