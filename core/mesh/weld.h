#pragma once

#include "papilio/mesh.h"

namespace papilio {

/// Makes points of equal position one vertex (to the bit, but -0 = 0), in the order in which the faces name
/// them. Returns the faces' vertices [3F], without the faces that have two equal ones; fills `positions` [V]
/// and the report's welded_points, isolated_points and degenerate_faces. Indices must be in range. O(n)
/// expected whatever the input: the hash has a seed of the process (the result does not depend on the seed).
/// `corner_point` [3F] is filled with the input's point at each corner if the input has attributes.
[[nodiscard]] Buffer<uint32_t> weld(const TriangleMesh& input, Buffer<Vec3f>& positions, BuildReport& report,
                                    std::vector<uint32_t>& corner_point);

}  // namespace papilio
