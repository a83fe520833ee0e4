#pragma once

#include <string>
#include <vector>

#include "proto/gltf/surface.h"

namespace papilio::proto::gltf {

/// Returns whether an attribute is JOINTS_n or WEIGHTS_n, and the set has the other, both of four components.
[[nodiscard]] bool is_joint_stream(const VertexSet& set, const std::string& semantic);

/// Interpolates all pairs JOINTS_n, WEIGHTS_n together. Adds weights by joint, keeps the largest, as many as the
/// vertices have places, and divides them by their sum. The sum of integers is exactly their largest number. Places
/// without a weight have joint 0.
[[nodiscard]] std::vector<VertexStream> interpolate_joints(const VertexSet& input, const RefinedVertices& vertices);

}  // namespace papilio::proto::gltf
