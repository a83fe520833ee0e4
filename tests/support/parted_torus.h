#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "papilio/mesh.h"
#include "tests/support/shapes.h"

// A torus about the z axis, in three parts whose borders have a closed form.

namespace papilio::test {

/// Returns the share of a turn about the z axis, 0..1.
[[nodiscard]] inline double turn_of(Vec3d place) {
  const double turn = std::atan2(place.y, place.x) / (2 * std::numbers::pi);
  return turn < 0 ? turn + 1 : turn;
}

/// Returns the part at a position: 0 in the first quarter of a turn, 1 in the second, otherwise 2.
[[nodiscard]] inline uint32_t part_of_torus(Vec3d place) {
  return std::min(2U, static_cast<uint32_t>(4 * turn_of(place)));
}

/// Returns the distance of a position to the nearest border of two parts.
[[nodiscard]] inline double distance_to_border(Vec3d p) {
  return std::min(std::abs(p.y), p.y >= 0 ? std::abs(p.x) : std::hypot(p.x, p.y));
}

/// Returns the part of each face of a torus of n by m cells; n must be a multiple of 4.
[[nodiscard]] inline std::vector<uint32_t> parts_of_torus(const TriangleMesh& torus) {
  std::vector<uint32_t> parts;
  for (const auto& [a, b, c] : torus.triangles)
    parts.push_back(part_of_torus(
        1 / 3.0 * (to_double(torus.positions[a]) + to_double(torus.positions[b]) + to_double(torus.positions[c]))));
  return parts;
}

}  // namespace papilio::test
