#pragma once

#include <string>
#include <string_view>

#include "proto/mesh_format.h"

namespace papilio::test {

/// Decodes a stream with Debian's `draco_decoder`, an independent program. Throws if it fails.
[[nodiscard]] TriangleMesh decode_with_draco_decoder(std::string_view draco);

/// Decodes with `draco_decoder` to OBJ, which stores vertices separately from texture coordinates and normals.
[[nodiscard]] proto::FormattedMesh decode_to_obj(std::string_view draco, size_t* positions = nullptr);
/// Encodes the mesh, as OBJ, with Debian's `draco_encoder`; 0 is fastest and sequential, 10 smallest.
[[nodiscard]] std::string encode_with_draco_encoder(const proto::FormattedMesh& mesh, int compression);

enum class Method { edgebreaker, sequential };
/// Encodes with libdraco's encoder and its defaults (11 bits), or sequentially.
[[nodiscard]] std::string encode_with_draco(const TriangleMesh& mesh, Method method, bool with_metadata = false);

/// Encodes the mesh's positions as a point cloud with libdraco.
[[nodiscard]] std::string encode_point_cloud(const TriangleMesh& mesh);

}  // namespace papilio::test
