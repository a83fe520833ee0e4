#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace papilio::proto::gltf {

/// How the geometry of a scene is compressed when it is written.
enum class Compression : uint8_t {
  same,     ///< each primitive as it was
  draco,    ///< by KHR_draco_mesh_compression
  meshopt,  ///< by EXT_meshopt_compression
  none
};

/// Names of the values, in their order.
inline constexpr std::array<std::string_view, 4> compression_names{"same", "draco", "meshopt", "none"};

}  // namespace papilio::proto::gltf
