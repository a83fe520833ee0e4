#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "client/lib/mesh_stream.h"
#include "proto/gltf/materials.h"

namespace papilio::client {

/// A mesh with its materials, and what of them could not be read: whole messages for the user.
struct MaterialRead {
  proto::gltf::MaterialMesh model;
  std::vector<std::string> warnings{};
};

/// `triangles_of` with the materials of a scene or an OBJ file; none of other formats. Files of materials and images
/// are read in the folder of `place` or below it; a name that leads elsewhere stands for the file of that name in the
/// folder. What is missing there, and images that are neither PNG nor JPEG, are left out with a warning. Throws
/// `FileError`, also where a material library is damaged or images exceed `kMaxFileBytes` together.
[[nodiscard]] MaterialRead read_with_materials(const MeshPlace& place, const MeshBytes& file);

/// Returns the materials of a .glb file whose only mesh is a packed model, or its plain Draco, for so many triangles
/// that its levels have: as many in a row below each of the base. Throws `Problem`.
[[nodiscard]] proto::gltf::Materials material_of_packed(std::string_view glb, size_t triangles);

}  // namespace papilio::client
