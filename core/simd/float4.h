#pragma once

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>

#include "papilio/buffer.h"
#include "papilio/vec3.h"
#include "simd/vec3fa.h"

namespace papilio {

// On x86-64 some loops are compiled twice: for every machine, and for those that have AVX2. Which one runs is found out
// when it runs; the results are the same to the bit.

/// Off only for tests of what machines without AVX2 do.
inline std::atomic<bool> may_use_avx2{true};
#if defined(__x86_64__)
#define PAPILIO_AVX2 gnu::target("avx2")
[[nodiscard]] inline bool has_avx2() {
  return __builtin_cpu_supports("avx2") != 0 && may_use_avx2.load(std::memory_order_relaxed);
}
template <class Work>
[[PAPILIO_AVX2]] void run_with_avx2(const Work& work) {
  work();
}
#endif
/// Behind the parameters of a lambda: what it calls and is to run as it does must be inlined, too.
#define PAPILIO_INLINED __attribute__((always_inline))
/// Runs work(), an inlined lambda, with the widest instructions that there are.
template <class Work>
void run_wide(const Work& work) {
#if defined(__x86_64__)
  if (has_avx2()) return run_with_avx2(work);
#endif
  work();
}

/// Four computations at once in floats: of edges, of faces. For what is to be told from a bound with a margin for
/// rounding; results proper are not made of it.
using Four = Lanes::Register;
using FourBits = int32_t __attribute__((vector_size(16)));  ///< of comparisons: all set where true, else none
using FourNumbers = std::array<uint32_t, 4>;

[[nodiscard]] inline Four lesser(Four a, Four b) { return a < b ? a : b; }
[[nodiscard]] inline Four larger(Four a, Four b) { return a > b ? a : b; }
[[nodiscard]] inline Four magnitude(Four a) { return larger(a, -a); }
[[nodiscard]] inline Four root(Four a) {
#if defined(__x86_64__)
  return _mm_sqrt_ps(a);
#endif
  return Four{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}

[[nodiscard]] inline bool is_any(FourBits truths) {
#if defined(__x86_64__)
  return _mm_movemask_ps(std::bit_cast<__m128>(truths)) != 0;
#endif
  const auto words = std::bit_cast<std::array<uint64_t, 2>>(truths);
  return (words[0] | words[1]) != 0;
}
[[nodiscard]] inline bool is_all(FourBits truths) { return !is_any(~truths); }

struct FourVectors {
  Four x, y, z;

  friend FourVectors operator+(const FourVectors& a, const FourVectors& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend FourVectors operator-(const FourVectors& a, const FourVectors& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend FourVectors operator*(float s, const FourVectors& a) { return {s * a.x, s * a.y, s * a.z}; }
};

[[nodiscard]] inline Four dot(const FourVectors& a, const FourVectors& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
[[nodiscard]] inline FourVectors cross(const FourVectors& a, const FourVectors& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// One of the four vectors, four times.
template <int which>
[[nodiscard]] inline FourVectors splat(const FourVectors& a) {
  return {__builtin_shufflevector(a.x, a.x, which, which, which, which),
          __builtin_shufflevector(a.y, a.y, which, which, which, which),
          __builtin_shufflevector(a.z, a.z, which, which, which, which)};
}
/// No less than the length.
[[nodiscard]] inline Four sum_of_magnitudes(const FourVectors& a) {
  return magnitude(a.x) + magnitude(a.y) + magnitude(a.z);
}

/// Four vectors, one beside the other.
[[nodiscard]] inline FourVectors transposed(Lanes one, Lanes two, Lanes three, Lanes four) {
  const auto [a, b, c, d] = std::array<Four, 4>{one.v, two.v, three.v, four.v};
  const Four ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const Four cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Four ab_behind = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Four cd_behind = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  return {__builtin_shufflevector(ab, cd, 0, 1, 4, 5), __builtin_shufflevector(ab, cd, 2, 3, 6, 7),
          __builtin_shufflevector(ab_behind, cd_behind, 0, 1, 4, 5)};
}

/// Of an array that has room for one behind its end (lanes.h).
[[nodiscard]] inline FourVectors at(const Vec3f* points, const FourNumbers& numbers) {
  return transposed(widen(points[numbers[0]]), widen(points[numbers[1]]), widen(points[numbers[2]]),
                    widen(points[numbers[3]]));
}
[[nodiscard]] inline FourVectors at(const Array<Vec3f>& points, const FourNumbers& numbers) {
  return at(points.data(), numbers);
}

/// One vector beside the other again, the fourth of each 0.
[[nodiscard]] inline std::array<Lanes, 4> transposed(const FourVectors& a) {
  const Four xy = __builtin_shufflevector(a.x, a.y, 0, 4, 1, 5);
  const Four z0 = __builtin_shufflevector(a.z, Four{}, 0, 4, 1, 5);
  const Four xy_behind = __builtin_shufflevector(a.x, a.y, 2, 6, 3, 7);
  const Four z0_behind = __builtin_shufflevector(a.z, Four{}, 2, 6, 3, 7);
  return {Lanes{__builtin_shufflevector(xy, z0, 0, 1, 4, 5)}, Lanes{__builtin_shufflevector(xy, z0, 2, 3, 6, 7)},
          Lanes{__builtin_shufflevector(xy_behind, z0_behind, 0, 1, 4, 5)},
          Lanes{__builtin_shufflevector(xy_behind, z0_behind, 2, 3, 6, 7)}};
}

/// True where the fourth power of a length, given squared, is surely a number that has all its digits.
[[nodiscard]] inline FourBits is_usual(Four length_squared) {
  return (length_squared > 1e-14F) & (length_squared < 1e16F);
}

}  // namespace papilio
