#pragma once

#include "detail/detail_level.h"
#include "papilio/mesh.h"

namespace papilio {

/// Returns [E] the directions of the residuals of a level's new vertices: unit normals of the edges, from the area
/// normals of all faces at both ends, or at an end on a curve, of the faces at the edge. Zero where they cancel out.
/// Bit-identical on every processor, by floats in a fixed order.
[[nodiscard]] Buffer<Vec3f> residual_normals(const DetailLevel& level, const Vec3f* positions);

/// Orthonormal tangents of residuals with three parts: perpendicular to the normal, the first as near as possible to
/// the edge.
struct Tangents {
  Vec3f along, across;
};
[[nodiscard]] Tangents residual_tangents(const Topology& level, const Vec3f* positions, uint32_t e, Vec3f normal);

}  // namespace papilio
