#pragma once

#include <functional>
#include <string_view>

#include "proto/gltf/json.h"
#include "proto/gltf/materials.h"

namespace papilio::proto::gltf {

/// Adds materials with their textures and images to a document: as of `Materials::gltf` if it is set, else as of
/// `Materials::materials`. `add_view` appends a view of an image's bytes and
/// returns its number. `has_coordinates`: whether the primitives have TEXCOORD_0. Drops images without bytes, and all
/// images without TEXCOORD_0. Reads names that are not UTF-8 as Latin-1.
void add_materials(Json& document, const Materials& materials, bool has_coordinates,
                   const std::function<size_t(std::string_view bytes)>& add_view);

}  // namespace papilio::proto::gltf
