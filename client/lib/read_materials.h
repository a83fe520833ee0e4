#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "client/lib/mesh_stream.h"
#include "proto/gltf/materials.h"

namespace papilio::client {

/// Mesh with its materials, and warnings of those that could not be read.
struct MaterialRead {
  proto::gltf::MaterialMesh model;
  std::vector<std::string> warnings{};
};

/// Returns the result of triangles_of() with the materials of a scene or an OBJ file. Files of materials and images are
/// read in the folder of `place` or below; of a name that leads elsewhere, only its last part is used. Missing files,
/// and images that are neither PNG nor JPEG, are skipped with a warning. Throws `FileError`, also for a damaged
/// material library, or images of more than `kMaxFileBytes` together.
[[nodiscard]] MaterialRead read_with_materials(const MeshPlace& place, const MeshBytes& file);

/// Returns the materials of a .glb file whose only mesh is a packed model, or its plain Draco, for `triangles`
/// triangles of a level: equally many consecutive ones below each triangle of the base. Throws `Problem`.
[[nodiscard]] proto::gltf::Materials material_of_packed(std::string_view glb, size_t triangles);

}  // namespace papilio::client
