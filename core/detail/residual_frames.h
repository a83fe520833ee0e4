#pragma once

#include "detail/detail_level.h"
#include "papilio/mesh.h"

namespace papilio {

/// Directions [E] along which the residuals of a level's new vertices lie: unit normals of the edges, from the area
/// normals of all faces at both ends. Of an end on a curve only the faces at the edge count. Zero where these cancel
/// out. Floats in a fixed order: the same bits everywhere.
[[nodiscard]] Buffer<Vec3f> residual_normals(const DetailLevel& level, const Vec3f* positions);

/// Two unit vectors across `normal`, the first along the edge as far as it may be: for residuals of three parts.
struct Tangents {
  Vec3f along, across;
};
[[nodiscard]] Tangents residual_tangents(const Topology& level, const Vec3f* positions, uint32_t e, Vec3f normal);

}  // namespace papilio
