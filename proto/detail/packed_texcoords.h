#pragma once

#include <optional>
#include <vector>

#include "papilio/mesh.h"
#include "proto/mesh_format.h"

// Texture coordinates and colours of packed models. Texture coordinates count downwards there, as glTF's do, and
// upwards in other meshes; colours are red, green and blue in bytes.

namespace papilio::proto::detail {

/// Returns the format of the attributes of bases and plain files: texture coordinates, colours, parts (as materials,
/// see proto/gltf/material_attribute.h), normals (`Attribute::unit_length`), or some of them.
[[nodiscard]] MeshFormat base_format(const std::vector<Attribute>& attributes);

/// Returns the first texture coordinates of two components, as packed models have them; nothing where there are none.
[[nodiscard]] std::optional<Attribute> texcoords_to_pack(const FormattedMesh& mesh);

/// Returns the first colours of three or four components, as packed models have them, without their opacity; nothing
/// where there are none.
[[nodiscard]] std::optional<Attribute> colours_to_pack(const FormattedMesh& mesh);
/// Whether any of those that are packed is not opaque.
[[nodiscard]] bool has_opacity(const FormattedMesh& mesh);

/// Rounds the colours among attributes to bytes that there are.
void round_colours(std::vector<Attribute>& attributes);

/// Turns the texture coordinates among attributes from packed models' to other meshes' direction, or back.
void turn_over(std::vector<Attribute>& attributes);

}  // namespace papilio::proto::detail
