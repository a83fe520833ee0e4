#pragma once

#include <array>
#include <optional>

#include "papilio/vec3.h"

namespace papilio::proto::gltf {

/// Affine map of space: the images of the axes, and of the origin.
struct Affine {
  std::array<Vec3d, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3d origin{};

  [[nodiscard]] Vec3d direction(Vec3d v) const { return v.x * axes[0] + v.y * axes[1] + v.z * axes[2]; }
  [[nodiscard]] Vec3d point(Vec3d p) const { return direction(p) + origin; }
  /// Returns the map that applies `inner` first.
  friend Affine operator*(const Affine& outer, const Affine& inner);
};

/// Returns the map of a translation, a unit quaternion (x, y, z, w) and a scale: glTF 2.0, section 3.5.3. The scale is
/// applied first.
[[nodiscard]] Affine affine_of(Vec3d translation, const std::array<double, 4>& rotation, Vec3d scale);

/// Returns an upper bound of the factor by which a map lengthens a vector; exact for similarities.
[[nodiscard]] double largest_scale(const Affine& map);
/// Returns whether a map scales all directions equally, within 0.1 %.
[[nodiscard]] bool is_similarity(const Affine& map);
/// Returns the inverse of a similarity, whose scale must not be 0.
[[nodiscard]] Affine inverse_of_similarity(const Affine& map);
/// Returns whether two maps are equal within 0.1 % of their scale.
[[nodiscard]] bool are_alike(const Affine& a, const Affine& b);

}  // namespace papilio::proto::gltf
