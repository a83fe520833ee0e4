#pragma once

#include <optional>

#include "proto/draco_writer.h"
#include "proto/gltf/json.h"
#include "proto/gltf/scene_mesh.h"
#include "proto/parameters.h"

namespace papilio::proto::gltf {

/// Encoding of a mesh's positions in a scene.
struct MeshGrid {
  OutputOptions output;
  double error = 0;  ///< distance by which the grid moves positions, a share of the mesh's diagonal; 0 without Draco
};

/// Returns the encoding of a mesh, and leaves to `options` (of the mesh) the tolerance beside its grid. By default the
/// grid is fine enough for the tolerance. `document`: JSON of the scene.
[[nodiscard]] MeshGrid choose_mesh_grid(const SceneMesh& mesh, const Json& document, const Parameters& parameters,
                                        std::optional<Options>& options);

}  // namespace papilio::proto::gltf
