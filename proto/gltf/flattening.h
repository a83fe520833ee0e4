#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "proto/limits.h"
#include "proto/mesh_format.h"

// Scenes as single meshes, and single meshes as scenes. Texture coordinates count upwards in meshes and downwards in
// glTF.

namespace papilio::proto::gltf {

/// Returns all triangles that the nodes of a .glb scene show, moved to where they are, skinned meshes as
/// the first joint that they use moves them. The
/// attributes are NORMAL, TEXCOORD_0 and COLOR_0, where any primitive has them; zero elsewhere. Materials are left out.
/// Throws `Problem`, also for more faces than the limit once each node has its own.
[[nodiscard]] FormattedMesh flatten_scene(std::string_view glb, const Limits& limits);

/// Returns the mesh of a .glb scene that shows one mesh once; nothing for other scenes. Throws `Problem`.
[[nodiscard]] std::optional<FormattedMesh> find_only_mesh(std::string_view glb, const Limits& limits);

/// Returns a .glb scene of one node with this mesh: positions, the first normals, texture coordinates and colours of
/// two to four components, and other attributes of one to four as custom ones.
[[nodiscard]] std::string scene_of_mesh(const FormattedMesh& mesh);

}  // namespace papilio::proto::gltf
