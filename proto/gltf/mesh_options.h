#pragma once

#include <optional>
#include <vector>

#include "papilio/mesh.h"
#include "papilio/options.h"
#include "proto/gltf/matrix.h"

namespace papilio::proto::gltf {

/// A mesh as the options of a scene see it.
struct PlacedMesh {
  const Mesh& mesh;
  double diagonal = 0;                           ///< of its box
  const std::vector<std::vector<Affine>>& maps;  ///< by showing and joint (scene.h)
  bool is_two_sided = false;                     ///< whether backs are shown too
};

/// Returns the options that refine one mesh as `options` say it for its scene, whose box has the diagonal
/// `scene_diagonal`; nothing if no showing is in the picture. Lengths are divided by the largest scale of the maps. A
/// view is moved into the mesh where the mesh is shown once, by a similarity. Else it becomes the tolerance of the
/// nearest point of the nearest showing: the mesh is as fine as any of them needs.
[[nodiscard]] std::optional<Options> options_of_mesh(const Options& options, double scene_diagonal,
                                                     const PlacedMesh& placed);

}  // namespace papilio::proto::gltf
