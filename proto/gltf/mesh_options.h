#pragma once

#include <optional>
#include <vector>

#include "papilio/mesh.h"
#include "papilio/options.h"
#include "proto/gltf/matrix.h"

namespace papilio::proto::gltf {

/// Mesh with its placement in a scene.
struct PlacedMesh {
  const Mesh& mesh;
  double diagonal = 0;                           ///< diagonal of its bounding box
  const std::vector<std::vector<Affine>>& maps;  ///< [instance][joint] maps to the scene (scene.h)
  bool is_two_sided = false;                     ///< whether faces are visible from behind
};

/// Converts options of a scene, whose box has the diagonal `scene_diagonal`, to options of one mesh; nothing if no
/// instance is visible. Lengths are divided by the largest scale of the maps. If the mesh has one instance, placed by a
/// similarity, the view is moved into the mesh. Otherwise the view becomes a tolerance, at the nearest point of the
/// nearest instance, so that the mesh is fine enough for all.
[[nodiscard]] std::optional<Options> options_of_mesh(const Options& options, double scene_diagonal,
                                                     const PlacedMesh& placed);

}  // namespace papilio::proto::gltf
