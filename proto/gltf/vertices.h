#pragma once

#include <vector>

#include "papilio/mesh.h"
#include "proto/gltf/geometry.h"

namespace papilio::proto::gltf {

/// Returns the positions of vertices, dequantized.
[[nodiscard]] Buffer<Vec3f> vertex_positions(const VertexSet& set);

/// Returns, for each vertex, the lowest one with bit-identical attributes and morph targets.
[[nodiscard]] std::vector<uint32_t> equal_vertices(const VertexSet& set);

}  // namespace papilio::proto::gltf
