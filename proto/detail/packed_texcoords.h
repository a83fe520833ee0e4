#pragma once

#include <optional>
#include <vector>

#include "papilio/mesh.h"
#include "proto/mesh_format.h"

// Texture coordinates and colours of packed models. Texture coordinates count downwards, as in glTF, but upwards in
// other meshes. Colours are red, green and blue in bytes.

namespace papilio::proto::detail {

/// Returns the format of attributes of bases and plain files, any of: texture coordinates, colours, part numbers (as
/// materials, proto/gltf/material_attribute.h), normals (`Attribute::unit_length`).
[[nodiscard]] MeshFormat base_format(const std::vector<Attribute>& attributes);

/// Returns the first texture coordinates of 2 components in the form of packed models; nothing if there are none.
[[nodiscard]] std::optional<Attribute> texcoords_to_pack(const FormattedMesh& mesh);

/// Returns the first colours of 3 or 4 components in the form of packed models, without opacity; nothing if there are
/// none.
[[nodiscard]] std::optional<Attribute> colours_to_pack(const FormattedMesh& mesh);
/// Returns whether any of the colours to pack is not opaque.
[[nodiscard]] bool has_opacity(const FormattedMesh& mesh);

/// Rounds the colours among attributes to integers in 0..255.
void round_colours(std::vector<Attribute>& attributes);

/// Converts the texture coordinates among attributes between packed models' and other meshes' direction.
void turn_over(std::vector<Attribute>& attributes);

}  // namespace papilio::proto::detail
