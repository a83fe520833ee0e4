#pragma once

#include "proto/gltf/materials.h"

namespace papilio::proto::detail {

/// Returns the materials that triangles use, in the order of their numbers, with their images. Those
/// of `Materials::gltf` have their images there alone, not in `Material::images`.
[[nodiscard]] gltf::Materials used_materials(const gltf::Materials& materials);

}  // namespace papilio::proto::detail
