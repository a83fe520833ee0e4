#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "proto/gltf/materials.h"
#include "proto/limits.h"
#include "proto/mesh_format.h"

// Scenes as single meshes, and single meshes as scenes. Texture coordinates count upwards in meshes and downwards in
// glTF.

namespace papilio::proto::gltf {

/// Returns all triangles that the nodes of a .glb scene show, moved to where they are, skinned meshes as
/// the first joint that they use moves them. The
/// attributes are NORMAL, TEXCOORD_0 and COLOR_0, where any primitive has them. Elsewhere each triangle has the normal
/// of its plane, texture coordinates are zero, and colours white. Materials are left out. Throws `Problem`, also for
/// more faces than the limit once each node has its own.
[[nodiscard]] FormattedMesh flatten_scene(std::string_view glb, const Limits& limits);

/// `flatten_scene` with the materials that the triangles have (material_reader.h). The texture coordinates are those at
/// which the material's first image is read: of the set that it names, transformed as KHR_texture_transform says.
[[nodiscard]] MaterialMesh flatten_with_materials(std::string_view glb, const Limits& limits);

/// Returns the mesh of a .glb scene that shows one mesh once; nothing for other scenes. Throws `Problem`.
[[nodiscard]] std::optional<FormattedMesh> find_only_mesh(std::string_view glb, const Limits& limits);

/// Returns a .glb scene of one node with this mesh: positions, the first normals, texture coordinates and colours of
/// two to four components, and other attributes of one to four as custom ones. With materials there is a primitive for
/// each that triangles have, in the order of their numbers, first one for those without; all share the vertices.
[[nodiscard]] std::string scene_of_mesh(const FormattedMesh& mesh, const Materials& materials = {});

}  // namespace papilio::proto::gltf
