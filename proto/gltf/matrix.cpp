#include "proto/gltf/matrix.h"

#include <algorithm>
#include <cmath>

namespace papilio::proto::gltf {
namespace {

constexpr double alike = 1e-3;

}  // namespace

Affine operator*(const Affine& outer, const Affine& inner) {
  return {{outer.direction(inner.axes[0]), outer.direction(inner.axes[1]), outer.direction(inner.axes[2])},
          outer.point(inner.origin)};
}

Affine affine_of(Vec3d translation, const std::array<double, 4>& rotation, Vec3d scale) {
  const auto [x, y, z, w] = rotation;
  return {{{scale.x * Vec3d{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
            scale.y * Vec3d{2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
            scale.z * Vec3d{2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}}},
          translation};
}

double largest_scale(const Affine& map) {
  double largest = 0;  // sum of the magnitudes in a row of the map's square, which bounds its eigenvalues
  for (const Vec3d& a : map.axes) {
    double row = 0;
    for (const Vec3d& b : map.axes) row += std::abs(dot(a, b));
    largest = std::max(largest, row);
  }
  return std::sqrt(largest);
}

bool is_similarity(const Affine& map) {
  const double square = dot(map.axes[0], map.axes[0]);
  if (!(square > 0)) return false;
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j)
      if (!(std::abs(dot(map.axes[i], map.axes[j]) - (i == j ? square : 0)) <= alike * square)) return false;
  return true;
}

Affine inverse_of_similarity(const Affine& map) {
  const double square = dot(map.axes[0], map.axes[0]);
  const auto transposed = [&](double Vec3d::*row) {
    return 1 / square * Vec3d{map.axes[0].*row, map.axes[1].*row, map.axes[2].*row};
  };
  Affine inverse{{transposed(&Vec3d::x), transposed(&Vec3d::y), transposed(&Vec3d::z)}, {}};
  inverse.origin = -1.0 * inverse.direction(map.origin);
  return inverse;
}

bool are_alike(const Affine& a, const Affine& b) {
  const double scale = std::max(largest_scale(a), largest_scale(b));
  for (size_t i = 0; i < 3; ++i)
    if (!(length(a.axes[i] - b.axes[i]) <= alike * scale)) return false;
  return length(a.origin - b.origin) <= alike * scale;
}

}  // namespace papilio::proto::gltf
