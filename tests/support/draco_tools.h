#pragma once

#include <string>
#include <string_view>

#include "proto/mesh_format.h"

namespace papilio::test {

/// Runs Debian's `draco_decoder`, an independent program, on a stream and reads what it writes. Throws when
/// it refuses.
[[nodiscard]] TriangleMesh decode_with_draco_decoder(std::string_view draco);

/// The same by way of OBJ, which keeps vertices apart from texture coordinates and normals.
[[nodiscard]] proto::FormattedMesh decode_to_obj(std::string_view draco, size_t* positions = nullptr);
/// Debian's `draco_encoder` on the mesh as OBJ; 0 is fastest and sequential, 10 smallest.
[[nodiscard]] std::string encode_with_draco_encoder(const proto::FormattedMesh& mesh, int compression);

/// Draco's own encoder with its defaults (11 bits) or sequentially, as other programs would make a stream.
enum class Method { edgebreaker, sequential };
[[nodiscard]] std::string encode_with_draco(const TriangleMesh& mesh, Method method, bool with_metadata = false);

/// Draco's own decoder on a point cloud made from the mesh's positions.
[[nodiscard]] std::string encode_point_cloud(const TriangleMesh& mesh);

}  // namespace papilio::test
