#pragma once

#include <optional>
#include <vector>

#include "proto/gltf/surface.h"

namespace papilio::proto::gltf {

/// What a refined surface makes of a morph target.
struct RefinedTarget {
  std::vector<Vec3d> displacement;  ///< [P] at the points of the refined mesh
  std::vector<Vec3d> turn;          ///< [P] what the whole displacement adds to the normals; empty: not known
};

/// Returns the morph targets of a refinement of `surface.mesh`. Displacements are those that the core made by the rules
/// of the surface. `normals`: number of the attribute with normals that were renewed; with it, and where any target
/// has normals, turns are known. O(P log P) for each target.
[[nodiscard]] std::vector<RefinedTarget> refine_targets(const MeshGeometry& geometry, const Surface& surface,
                                                        const Mesh& refined, std::optional<size_t> normals);

}  // namespace papilio::proto::gltf
