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

/// Returns all triangles that the nodes of a .glb scene show, in the scene's coordinates. Skinned meshes are moved by
/// the first joint that they use. Attributes are NORMAL, TEXCOORD_0 and COLOR_0, if any primitive has them. Primitives
/// without them get the normals of their triangles, zero texture coordinates, and white. Materials are dropped. Throws
/// `Problem`, also if the faces of all nodes together exceed the limit.
[[nodiscard]] FormattedMesh flatten_scene(std::string_view glb, const Limits& limits);

/// Returns the result of flatten_scene() with the triangles' materials (material_reader.h). Texture coordinates are
/// those of the material's first image: of its set, transformed by KHR_texture_transform.
[[nodiscard]] MaterialMesh flatten_with_materials(std::string_view glb, const Limits& limits);

/// Returns the mesh of a .glb scene with a single instance; nothing for other scenes. Throws `Problem`.
[[nodiscard]] std::optional<FormattedMesh> find_only_mesh(std::string_view glb, const Limits& limits);

/// Returns a .glb scene of one node with a mesh: positions, first normals, texture coordinates and colours of 2 to 4
/// components, and other attributes of 1 to 4 components as custom ones. With materials, it has a primitive for the
/// triangles without a material, and one for each material in use, in the order of their numbers. All share the
/// vertices.
[[nodiscard]] std::string scene_of_mesh(const FormattedMesh& mesh, const Materials& materials = {});

}  // namespace papilio::proto::gltf
