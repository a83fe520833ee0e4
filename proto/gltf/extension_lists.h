#pragma once

#include "proto/gltf/json.h"

namespace papilio::proto::gltf {

/// Makes extensionsUsed and extensionsRequired name the extensions of geometry that the document uses, and no other of
/// them: Draco, meshopt. The residuals of packed models are not named any more where there are none. Other names stay.
void list_extensions(Json& document);

/// Returns whether the extension is used anywhere in a value, extras left out.
[[nodiscard]] bool uses_extension(const Json& value, const char* name);

/// Returns whether a document says that Draco or meshopt compresses some of it.
[[nodiscard]] bool uses_compression(const Json& document);

}  // namespace papilio::proto::gltf
