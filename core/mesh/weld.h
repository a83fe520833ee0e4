#pragma once

#include "papilio/mesh.h"

namespace papilio {

/// Welds points of equal position (bit-identical, or -0 and 0) to vertices, in the order in which the faces first use
/// them. Returns the faces' vertices [3F], without faces that have two equal ones. Fills `positions` [V] and the
/// report's welded_points, isolated_points and degenerate_faces. If the input has attributes, fills `corner_point` [3F]
/// with the input's point at each corner. Indices must be in range. O(n) expected for any input, by a random hash seed;
/// the result does not depend on the seed.
[[nodiscard]] Buffer<uint32_t> weld(const TriangleMesh& input, Buffer<Vec3f>& positions, BuildReport& report,
                                    std::vector<uint32_t>& corner_point);

}  // namespace papilio
