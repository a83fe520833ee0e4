#pragma once

#include <optional>
#include <vector>

#include "papilio/mesh.h"
#include "proto/mesh_format.h"

// Texture coordinates of packed models. They count downwards there, as glTF's do, and upwards in other meshes.

namespace papilio::proto::detail {

/// Returns the format of the attributes of bases and plain files: texture coordinates, parts (as materials, see
/// proto/gltf/material_attribute.h), normals (`Attribute::unit_length`), or some of them.
[[nodiscard]] MeshFormat base_format(const std::vector<Attribute>& attributes);

/// Returns the first texture coordinates of two components, as packed models have them; nothing where there are none.
[[nodiscard]] std::optional<Attribute> texcoords_to_pack(const FormattedMesh& mesh);

/// Turns the texture coordinates among attributes from packed models' to other meshes' direction, or back.
void turn_over(std::vector<Attribute>& attributes);

}  // namespace papilio::proto::detail
