#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

#include "papilio/vec3.h"

namespace papilio {

/// Three floats in a register of four, as Embree's type of this name, for the loops that cost most. Each lane is
/// rounded as a float is, so results are those of Vec3f to the bit. The fourth lane is never used. Compilers have such
/// types for every processor.
struct Vec3fa {
  using Register = float __attribute__((vector_size(16)));
  Register v;

  friend Vec3fa operator+(Vec3fa a, Vec3fa b) { return {a.v + b.v}; }
  friend Vec3fa operator-(Vec3fa a, Vec3fa b) { return {a.v - b.v}; }
  friend Vec3fa operator*(float s, Vec3fa a) { return {s * a.v}; }
  Vec3fa& operator+=(Vec3fa b) { return *this = *this + b; }
};

/// Lane by lane.
inline Vec3fa larger(Vec3fa a, Vec3fa b) { return {a.v > b.v ? a.v : b.v}; }
inline Vec3fa lesser(Vec3fa a, Vec3fa b) { return {a.v < b.v ? a.v : b.v}; }
/// Of the first three lanes.
inline float squared_length(Vec3fa a) { return a.v[0] * a.v[0] + a.v[1] * a.v[1] + a.v[2] * a.v[2]; }

/// What rules compute with: `Vec3fa` in the product, plain vectors where a test checks the arithmetic in double.
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

/// Reads four floats: the array must be a `Buffer` (papilio/buffer.h), whose memory goes on behind its end. The fourth
/// is not of this point, and another thread may be writing it: whatever it is, nothing is made of it. (The thread
/// sanitizer cannot know; for it three are read.)
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

/// Stores q, or the sum of p and q: without a branch, for who comes first to an edge is not foreseen.
inline void add_share(bool to_what_is_there, Vec3fa q, Vec3f& p) {
  using Bits = int32_t __attribute__((vector_size(16)));
  const int32_t mask = to_what_is_there ? -1 : 0;
  const Bits there = std::bit_cast<Bits>(widen(p).v) & Bits{mask, mask, mask, mask};
  store(Vec3fa{std::bit_cast<Vec3fa::Register>(there)} + q, p);
}
inline void add_share(bool to_what_is_there, const Vec3d& q, Vec3d& p) { p = to_what_is_there ? p + q : q; }

}  // namespace papilio
