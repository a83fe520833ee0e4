#pragma once

#include "proto/gltf/json.h"

namespace papilio::proto::gltf {

/// Makes extensionsUsed and extensionsRequired name the extensions of geometry that the document uses, and no other of
/// them: Draco, meshopt, quantization. Other names stay.
void list_extensions(Json& document);

}  // namespace papilio::proto::gltf
