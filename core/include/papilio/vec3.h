#pragma once

#include <cmath>

namespace papilio {

/// Vector of three coordinates. `Real` is float in the product, and double where a test checks the arithmetic itself.
template <class Real>
struct Vec3T {
  Real x{}, y{}, z{};

  friend bool operator==(const Vec3T&, const Vec3T&) = default;
  friend Vec3T operator+(Vec3T a, Vec3T b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3T operator-(Vec3T a, Vec3T b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3T operator*(Real s, Vec3T a) { return {s * a.x, s * a.y, s * a.z}; }
  Vec3T& operator+=(Vec3T b) { return *this = *this + b; }
  Vec3T& operator-=(Vec3T b) { return *this = *this - b; }
};

using Vec3f = Vec3T<float>;
using Vec3d = Vec3T<double>;

template <class Real>
Real dot(Vec3T<Real> a, Vec3T<Real> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Real>
Vec3T<Real> cross(Vec3T<Real> a, Vec3T<Real> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class Real>
Real length(Vec3T<Real> a) {
  return std::sqrt(dot(a, a));
}

inline Vec3d to_double(Vec3f a) { return {a.x, a.y, a.z}; }
inline Vec3d to_double(Vec3d a) { return a; }
inline Vec3f to_float(Vec3d a) { return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)}; }

}  // namespace papilio
