#pragma once

#include "proto/gltf/json.h"

namespace papilio::proto::gltf {

/// Most bytes of JSON that copies of meshes may add.
inline constexpr uint64_t most_copied_json = uint64_t{16} << 20;

/// Gives each node a mesh of its own: where several show one, all but the first get copies, at the end of the
/// document's meshes. Copies refer to the same accessors. The instances of one node (EXT_mesh_gpu_instancing) keep one
/// mesh. Throws `Problem`: mesh_not_gltf, mesh_too_large.
void split_instances(Json& document);

}  // namespace papilio::proto::gltf
