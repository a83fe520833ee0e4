#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "proto/limits.h"

namespace papilio::proto::gltf {

/// Describes a .glb scene as a JSON object: counts of its parts, faces and vertices of all meshes, its box,
/// compression, and each mesh with its faces, vertices, primitives and attributes. Throws `Problem`.
[[nodiscard]] std::string describe_scene(std::string_view glb, const Limits& limits);

/// Returns the number of triangles that the primitives of a .glb scene declare. Reads only its JSON. Throws `Problem`.
[[nodiscard]] uint64_t declared_faces(std::string_view glb);

}  // namespace papilio::proto::gltf
