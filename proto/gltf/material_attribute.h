#pragma once

#include "proto/gltf/materials.h"
#include "proto/mesh_format.h"

// Materials in a Draco stream: the number of each face's material as an attribute, which refinement keeps constant in
// each face. Points at a border between materials are split; positions stay closed.

namespace papilio::proto::gltf {

/// Name of the generic attribute of one integer that holds each face's material at its points: 0 for none, else 1 + its
/// number.
inline constexpr const char* material_attribute_name = "material";

/// Returns the attribute's format, with `id` in a Draco stream.
[[nodiscard]] AttributeFormat material_format(uint32_t id);

/// Adds the attribute as the last one, and splits points between materials.
void add_material_attribute(MaterialMesh& model);

/// Returns whether the mesh has the attribute.
[[nodiscard]] bool has_material_attribute(const FormattedMesh& mesh);

/// Removes the attribute from a mesh, and returns each triangle's material as of `Materials::of_triangle`: `none` for
/// numbers of at least `count`, and in a mesh without the attribute.
[[nodiscard]] std::vector<uint32_t> take_material_attribute(FormattedMesh& mesh, size_t count);

}  // namespace papilio::proto::gltf
