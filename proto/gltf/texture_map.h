#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "proto/gltf/json.h"

namespace papilio::proto::gltf {

/// Texture coordinates of a texture: the set, and the affine map of KHR_texture_transform.
struct TextureMap {
  uint32_t set = 0;  ///< number n of TEXCOORD_n
  std::array<double, 2> scale{1, 1}, offset{};
  double rotation = 0;                               ///< counter-clockwise, in radians
  std::array<double, 2> u_axis{1, 0}, v_axis{0, 1};  ///< columns of the scaled rotation

  /// Returns the coordinates at which the image is read.
  [[nodiscard]] std::array<double, 2> point(double u, double v) const {
    return {u_axis[0] * u + v_axis[0] * v + offset[0], u_axis[1] * u + v_axis[1] * v + offset[1]};
  }
  friend bool operator==(const TextureMap&, const TextureMap&) = default;
};

/// Reads the map of a texture info. Throws `Problem`; `where` names the info.
[[nodiscard]] TextureMap read_texture_map(const Json& info, const std::string& where);

/// Rewrites the map of a texture info for coordinates of TEXCOORD_0 that are already transformed by `done`. `map`: the
/// info's map, of the set of `done`. Returns false, and changes nothing, if no KHR_texture_transform gives the result.
[[nodiscard]] bool rewrite_texture_map(Json& info, const TextureMap& map, const TextureMap& done);

}  // namespace papilio::proto::gltf
