#pragma once

#include <cstring>

#include "vec3.h"

namespace papilio {

/// Three floats in a register of four, for the loops that cost most. Each lane is rounded as a float is, so that
/// results are those of Vec3f to the bit; the fourth is never looked at. Compilers have such types for every machine.
struct Lanes {
  using Register = float __attribute__((vector_size(16)));
  Register v;

  friend Lanes operator+(Lanes a, Lanes b) { return {a.v + b.v}; }
  friend Lanes operator-(Lanes a, Lanes b) { return {a.v - b.v}; }
  friend Lanes operator*(float s, Lanes a) { return {s * a.v}; }
  Lanes& operator+=(Lanes b) { return *this = *this + b; }
};

/// What rules compute with: `Lanes` in the product, plain vectors where a test checks the arithmetic in double.
template <class Real>
struct WideOf {
  using Type = Vec3T<Real>;
};
template <>
struct WideOf<float> {
  using Type = Lanes;
};
template <class Real>
using Wide = typename WideOf<Real>::Type;

/// Reads four floats: the array must be an `Array` (array.h), which has room for one behind its end.
inline Lanes widen(const Vec3f& p) {
  Lanes lanes;
  std::memcpy(&lanes, &p, sizeof(lanes));
  return lanes;
}
inline Vec3d widen(const Vec3d& p) { return p; }

inline void store(Lanes lanes, Vec3f& p) { p = {lanes.v[0], lanes.v[1], lanes.v[2]}; }
inline void store(const Vec3d& q, Vec3d& p) { p = q; }

template <class Real>
void add_to(Vec3T<Real>& p, const Wide<Real>& q) {
  store(widen(p) + q, p);
}

}  // namespace papilio
