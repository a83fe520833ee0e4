#pragma once

#include "proto/gltf/json.h"

namespace papilio::proto::gltf {

/// Upper bound of the JSON bytes that copies of meshes may add.
inline constexpr uint64_t most_copied_json = uint64_t{16} << 20;

/// Gives each node a mesh of its own: all but the first node of a mesh get copies, at the end of the document's meshes.
/// Copies share accessors. The instances of one node (EXT_mesh_gpu_instancing) share one mesh. Throws `Problem`:
/// mesh_not_gltf, mesh_too_large.
void split_instances(Json& document);

}  // namespace papilio::proto::gltf
