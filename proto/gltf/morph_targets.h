#pragma once

#include <optional>
#include <vector>

#include "proto/gltf/surface.h"

namespace papilio::proto::gltf {

/// Morph target of a refined surface.
struct RefinedTarget {
  std::vector<Vec3d> displacement;  ///< [P] displacements at the points of the refined mesh
  std::vector<Vec3d> turn;          ///< [P] changes of the normals by the full displacement; empty if unknown
};

/// Returns the morph targets of a refinement of `surface.mesh`, with displacements that the core refined by the rules
/// of the surface. `normals`: number of the attribute with recomputed normals; turns are known if it is given and any
/// target has normals. O(P log P) for each target.
[[nodiscard]] std::vector<RefinedTarget> refine_targets(const MeshGeometry& geometry, const Surface& surface,
                                                        const Mesh& refined, std::optional<size_t> normals);

}  // namespace papilio::proto::gltf
