#pragma once

#include "proto/gltf/morph_targets.h"

namespace papilio::proto::gltf {

/// Vectors of a mesh that keep their format: all primitives share it, and it can store the refined vectors. Other
/// vectors become floats in all primitives, as borders between rounded and exact vertices would open.
struct KeptFormats {
  bool positions = true;
  std::vector<bool> displacements{};  ///< by morph target
};

/// Returns the vectors that keep their format. `vertices`: refined vertices of the geometry's sets.
[[nodiscard]] KeptFormats find_kept_formats(const MeshGeometry& geometry, const std::vector<RefinedVertices>& vertices,
                                            const std::vector<RefinedTarget>& targets);

/// Returns the vertices of a refined set with all attributes and morph targets of the input:
/// - POSITION and NORMAL come from the refined vertices; quantized positions keep their grid or become floats, by
/// `kept`.
/// - TANGENT is interpolated and made perpendicular to the normal.
/// - JOINTS_n and WEIGHTS_n keep the largest interpolated weights, as many as the set has, with the sum 1.
/// - Feature IDs, and integers without a declared range, are copied from the nearest vertex.
/// - Of morph targets, POSITION, and NORMAL if its turn is known, come from `targets`.
/// - All other values are interpolated linearly.
///
/// Vertices of the input keep their bytes, except normals and tangents. `adds_normals`: whether a set without NORMAL
/// gets it.
[[nodiscard]] VertexSet interpolate_vertices(const VertexSet& input, const RefinedVertices& vertices,
                                             const std::vector<RefinedTarget>& targets, const KeptFormats& kept,
                                             bool adds_normals);

}  // namespace papilio::proto::gltf
