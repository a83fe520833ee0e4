#pragma once

#include <optional>
#include <vector>

#include "papilio/mesh.h"
#include "proto/mesh_format.h"

// Texture coordinates of packed models. They count downwards there, as glTF's do, and upwards in other meshes.

namespace papilio::proto::detail {

/// Returns the format of the attributes of bases and plain files: of none, of texture coordinates, of normals
/// (`Attribute::unit_length`), or of both.
[[nodiscard]] MeshFormat base_format(const std::vector<Attribute>& attributes);

/// Returns the first texture coordinates of two components, as packed models have them; nothing where there are none.
[[nodiscard]] std::optional<Attribute> texcoords_to_pack(const FormattedMesh& mesh);

/// Turns texture coordinates from packed models' to other meshes' direction, or back.
void turn_over(Attribute& texcoords);

}  // namespace papilio::proto::detail
