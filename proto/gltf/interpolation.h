#pragma once

#include "proto/gltf/morph_targets.h"

namespace papilio::proto::gltf {

/// Returns the vertices of a refined set with all attributes and morph targets of the input's.
///
/// POSITION and NORMAL are those of the refined vertices; quantized positions keep their grid, and become floats where
/// it does not reach. TANGENT is interpolated and made perpendicular to the normal. Of JOINTS_n and WEIGHTS_n the
/// largest weights of the interpolated joints are kept, as many as the set has, with the sum 1. Feature IDs and
/// integers without a declared range, which identify something, are those of the nearest vertex. Of morph targets
/// POSITION, and NORMAL where its turn is known, are those of `targets`. All else is interpolated linearly. Vertices of
/// the input keep their bytes, but for normals and tangents. `adds_normals`: gives NORMAL to a set without.
[[nodiscard]] VertexSet interpolate_vertices(const VertexSet& input, const RefinedVertices& vertices,
                                             const std::vector<RefinedTarget>& targets, bool adds_normals);

}  // namespace papilio::proto::gltf
