#pragma once

#include <functional>
#include <string_view>

#include "proto/gltf/json.h"
#include "proto/gltf/materials.h"

namespace papilio::proto::gltf {

/// Adds materials with their textures and images to a document. `add_view` appends a view of an image's bytes and
/// returns its number. `has_coordinates`: whether the primitives have TEXCOORD_0; without it images are left out.
/// Images without bytes are left out too. Names that are not UTF-8 are taken for Latin-1.
void add_materials(Json& document, const Materials& materials, bool has_coordinates,
                   const std::function<size_t(std::string_view bytes)>& add_view);

}  // namespace papilio::proto::gltf
