#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

#include "papilio/vec3.h"

namespace papilio {

/// Three floats in a register of four, like Embree's type of this name, for hot loops. Each lane is rounded as a float,
/// so results are bit-identical to Vec3f. The fourth lane is never used. Compilers provide the vector type for every
/// processor.
struct Vec3fa {
  using Register = float __attribute__((vector_size(16)));
  Register v;

  friend Vec3fa operator+(Vec3fa a, Vec3fa b) { return {a.v + b.v}; }
  friend Vec3fa operator-(Vec3fa a, Vec3fa b) { return {a.v - b.v}; }
  friend Vec3fa operator*(float s, Vec3fa a) { return {s * a.v}; }
  Vec3fa& operator+=(Vec3fa b) { return *this = *this + b; }
};

/// Returns the maximum or minimum of each lane.
inline Vec3fa larger(Vec3fa a, Vec3fa b) { return {a.v > b.v ? a.v : b.v}; }
inline Vec3fa lesser(Vec3fa a, Vec3fa b) { return {a.v < b.v ? a.v : b.v}; }
/// Returns the sum of squares of the first three lanes.
inline float squared_length(Vec3fa a) { return a.v[0] * a.v[0] + a.v[1] * a.v[1] + a.v[2] * a.v[2]; }

/// Vector type of the rules' arithmetic: `Vec3fa` for float, `Vec3d` where a test checks the arithmetic in double.
template <class Real>
struct WideOf {
  using Type = Vec3T<Real>;
};
template <>
struct WideOf<float> {
  using Type = Vec3fa;
};
template <class Real>
using Wide = typename WideOf<Real>::Type;

/// Reads four floats: the array must be a `Buffer` (papilio/buffer.h), whose memory extends behind its end. The fourth
/// belongs to the next point and may be written by another thread; its value is never used. Under the thread sanitizer,
/// which would report it, only three are read.
inline Vec3fa widen(const Vec3f& p) {
#if defined(__SANITIZE_THREAD__)
  return {Vec3fa::Register{p.x, p.y, p.z, 0}};
#else
  Vec3fa lanes;
  std::memcpy(&lanes, &p, sizeof(lanes));
  return lanes;
#endif
}
inline Vec3d widen(const Vec3d& p) { return p; }

inline void store(Vec3fa lanes, Vec3f& p) { p = {lanes.v[0], lanes.v[1], lanes.v[2]}; }
inline void store(const Vec3d& q, Vec3d& p) { p = q; }

/// Adds q to p if `accumulate`, else stores q in p. Branch-free: which face is first at an edge is unpredictable.
inline void add_share(bool accumulate, Vec3fa q, Vec3f& p) {
  using Bits = int32_t __attribute__((vector_size(16)));
  const int32_t mask = accumulate ? -1 : 0;
  const Bits there = std::bit_cast<Bits>(widen(p).v) & Bits{mask, mask, mask, mask};
  store(Vec3fa{std::bit_cast<Vec3fa::Register>(there)} + q, p);
}
inline void add_share(bool accumulate, const Vec3d& q, Vec3d& p) { p = accumulate ? p + q : q; }

}  // namespace papilio
