#pragma once

#include "proto/gltf/materials.h"
#include "proto/mesh_format.h"

// Materials through a Draco stream: the number of each face's material as an attribute, which refinement keeps constant
// in each face. Points at a border between materials come apart, their positions do not.

namespace papilio::proto::gltf {

/// Name of the generic attribute of one integer that holds each face's material at its points: 0 for none, else its
/// number and one.
inline constexpr const char* material_attribute_name = "material";

/// Returns the attribute's format, with this id in a Draco stream.
[[nodiscard]] AttributeFormat material_format(uint32_t id);

/// Adds the attribute as the last one; divides points between materials.
void add_material_attribute(MaterialMesh& model);

/// Returns whether the mesh has the attribute.
[[nodiscard]] bool has_material_attribute(const FormattedMesh& mesh);

/// Takes the attribute out of a mesh; returns each triangle's material as `Materials::of_triangle` has it. Numbers of
/// `count` and more, and a mesh without the attribute, give `none`.
[[nodiscard]] std::vector<uint32_t> take_material_attribute(FormattedMesh& mesh, size_t count);

}  // namespace papilio::proto::gltf
