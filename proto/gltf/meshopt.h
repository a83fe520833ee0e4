#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "proto/gltf/json.h"

namespace papilio::proto::gltf {

/// Codec of a compressed view.
enum class MeshoptMode { attributes, triangles, indices };

/// Storage of a view by EXT_meshopt_compression.
struct MeshoptView {
  uint32_t buffer = 0;
  uint64_t offset = 0, length = 0;  ///< compressed bytes in the buffer
  uint32_t stride = 0;              ///< bytes of a decoded element
  uint64_t count = 0;               ///< number of decoded elements
  MeshoptMode mode = MeshoptMode::attributes;
  std::string filter = "NONE";
};

/// Reads the extension of a buffer view, if it has one. `where` names the view. Throws `Problem`: mesh_not_gltf for
/// values outside of the extension's ranges, mesh_unsupported for its successor.
[[nodiscard]] std::optional<MeshoptView> read_meshopt_view(const Json& view, const std::string& where);

/// Decodes a view: `count` elements of `stride` bytes. Checks the size against the largest compression ratio before it
/// is allocated. Throws `Problem`: mesh_not_gltf for damaged bytes, mesh_unsupported for a newer codec.
[[nodiscard]] std::string decode_meshopt(const MeshoptView& view, std::string_view compressed,
                                         const std::string& where);

/// Encodes elements of `stride` bytes, a multiple of 4 up to 256.
[[nodiscard]] std::string encode_meshopt_attributes(std::string_view elements, uint32_t stride);
/// Encodes indices of triangles, of 2 or 4 bytes each.
[[nodiscard]] std::string encode_meshopt_triangles(std::string_view indices, uint32_t stride);

}  // namespace papilio::proto::gltf
