#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "papilio/detail.h"

namespace papilio::test {

/// Residual of an edge's new vertex along the normal, in steps, as a function of the level (the first is 0), the edge's
/// number and its midpoint.
using ResidualOfEdge = std::function<int32_t(int level, uint32_t edge, Vec3f middle)>;

/// Encodes levels with these residuals, in this many pieces each. The step of each level is a quarter of the previous
/// level's.
[[nodiscard]] DetailSource detail_of_residuals(const TriangleMesh& base, int levels, float first_step,
                                               const ResidualOfEdge& residual,
                                               const std::vector<uint32_t>& piece_counts = {1});

/// Returns the base with its levels attached.
[[nodiscard]] Mesh with_detail(const DetailSource& source);

}  // namespace papilio::test
