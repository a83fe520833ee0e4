#pragma once

#include <vector>

#include "mesh/displacement.h"
#include "mesh/split_plan.h"
#include "papilio/mesh.h"

namespace papilio {

/// Throws `Error`: not_finite (a value of an attribute), index_out_of_range (not one value a point).
void check_attributes(const TriangleMesh& input);

/// The attributes of a mesh built from `input`: corner_point [H] names the input's point at each half-edge's origin.
/// Points of one vertex with equal values become one point, so that only true seams remain. Empty where the input has
/// no attributes. Throws `Error`: not_finite (a value), index_out_of_range (not one value a point).
[[nodiscard]] PointAttributes gather_attributes(const TriangleMesh& input, const Topology& mesh,
                                                const std::vector<uint32_t>& corner_point);

/// The values of a point, of an attribute of three components.
[[nodiscard]] inline Vec3d vector_at(const Attribute& attribute, uint32_t point) {
  const double* value = &attribute.values[size_t{3} * point];
  return {value[0], value[1], value[2]};
}

/// Whether the two faces at a half-edge that has a twin have different points at its ends. None have without
/// attributes.
[[nodiscard]] inline bool is_seam(const Topology& mesh, const PointAttributes& attributes, uint32_t h) {
  const Buffer<uint32_t>& point = attributes.point;
  const uint32_t t = mesh.twin[h];
  return !attributes.empty() && (point[h] != point[Topology::next(t)] || point[Topology::next(h)] != point[t]);
}

/// Makes the points on the split edges: each the mean of the two at its ends, one for both faces where they agree on
/// both, else (on a seam) one for each face. Returns [H] the new point on each half-edge of a split edge; `none`
/// elsewhere, and on faces that are not among `faces`, which are in ascending order. `displaced`: displacements at the
/// new vertices, and given texture coordinates, in place of the means where they are known.
[[nodiscard]] Buffer<uint32_t> split_points(const Topology& mesh, const EdgeMarks& split, const Buffer<uint32_t>& faces,
                                            PointAttributes& attributes, const Displacements& displaced = {});

}  // namespace papilio
