#pragma once

#include "proto/gltf/json.h"

namespace papilio::proto::gltf {

/// Updates extensionsUsed and extensionsRequired for Draco, meshopt, and the residuals of packed models: they list
/// exactly the ones in use. Other names are kept.
void list_extensions(Json& document);

/// Adds to the lists of `document` the extensions that it uses of those in the lists of `source`.
void add_listed_extensions(Json& document, const Json& source);

/// Returns whether the extension is used anywhere in a value, except in extras.
[[nodiscard]] bool uses_extension(const Json& value, const char* name);

/// Returns whether a document declares compression by Draco or meshopt.
[[nodiscard]] bool uses_compression(const Json& document);

}  // namespace papilio::proto::gltf
