#pragma once

#include <optional>

#include "proto/gltf/materials.h"

namespace papilio::proto::detail {

/// Returns the material that all triangles have, alone, with its images; nothing where they have none or several.
[[nodiscard]] std::optional<gltf::Materials> only_material(const gltf::Materials& materials);

}  // namespace papilio::proto::detail
