#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace papilio::proto::gltf {

/// Compression of the geometry of a written scene.
enum class Compression : uint8_t {
  same,     ///< compression of each primitive in the input
  draco,    ///< KHR_draco_mesh_compression
  meshopt,  ///< EXT_meshopt_compression
  none
};

/// Names of the values, in their order.
inline constexpr std::array<std::string_view, 4> compression_names{"same", "draco", "meshopt", "none"};

}  // namespace papilio::proto::gltf
