#pragma once

#include <vector>

#include "papilio/mesh.h"
#include "proto/gltf/geometry.h"

namespace papilio::proto::gltf {

/// Returns the positions of vertices, quantized ones as what they stand for.
[[nodiscard]] Buffer<Vec3f> vertex_positions(const VertexSet& set);

/// Returns for each vertex the lowest one that equals it in all attributes and morph targets, to the bit.
[[nodiscard]] std::vector<uint32_t> equal_vertices(const VertexSet& set);

}  // namespace papilio::proto::gltf
