#pragma once

#include "proto/gltf/morph_targets.h"

namespace papilio::proto::gltf {

/// Which vectors of a mesh keep their format: those that all primitives have in one format, which can store the refined
/// ones. Others become floats in all primitives, as borders between rounded and exact vertices would open.
struct KeptFormats {
  bool positions = true;
  std::vector<bool> displacements{};  ///< by morph target
};

/// Returns which formats are kept. `vertices`: of the sets of the geometry, refined.
[[nodiscard]] KeptFormats find_kept_formats(const MeshGeometry& geometry, const std::vector<RefinedVertices>& vertices,
                                            const std::vector<RefinedTarget>& targets);

/// Returns the vertices of a refined set with all attributes and morph targets of the input's.
///
/// POSITION and NORMAL are those of the refined vertices; quantized positions keep their grid or become floats, as
/// `kept` says. TANGENT is interpolated and made perpendicular to the normal. Of JOINTS_n and WEIGHTS_n the
/// largest weights of the interpolated joints are kept, as many as the set has, with the sum 1. Feature IDs and
/// integers without a declared range, which identify something, are those of the nearest vertex. Of morph targets
/// POSITION, and NORMAL where its turn is known, are those of `targets`. All else is interpolated linearly. Vertices of
/// the input keep their bytes, but for normals and tangents. `adds_normals`: gives NORMAL to a set without.
[[nodiscard]] VertexSet interpolate_vertices(const VertexSet& input, const RefinedVertices& vertices,
                                             const std::vector<RefinedTarget>& targets, const KeptFormats& kept,
                                             bool adds_normals);

}  // namespace papilio::proto::gltf
