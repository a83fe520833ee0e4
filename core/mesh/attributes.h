#pragma once

#include <span>
#include <vector>

#include "base/ids.h"
#include "base/index_range.h"
#include "mesh/displacement.h"
#include "mesh/marks.h"
#include "papilio/mesh.h"

namespace papilio {

/// Throws `Error`: not_finite (a value of an attribute), index_out_of_range (a number of values that differs from the
/// points').
void check_attributes(const TriangleMesh& input);

/// Returns the attributes of a mesh built from `input`, empty if it has none. `corner_point` [H] is the input's point
/// at each half-edge's origin. Points of one vertex with equal values become one point, so that only true seams remain.
/// Throws as check_attributes().
[[nodiscard]] PointAttributes gather_attributes(const TriangleMesh& input, const Topology& mesh,
                                                const std::vector<uint32_t>& corner_point);

/// Returns the values of a point.
[[nodiscard]] inline std::span<const double> values_of(const Attribute& attribute, uint32_t point) {
  return {attribute.values.data() + size_t{point} * attribute.components, attribute.components};
}

/// Returns the value of a point of an attribute with 3 components.
[[nodiscard]] inline Vec3d vector_at(const Attribute& attribute, uint32_t point) {
  const double* value = &attribute.values[size_t{3} * point];
  return {value[0], value[1], value[2]};
}

/// Returns whether the two faces at a half-edge with a twin have different points at one of its ends; false without
/// attributes.
[[nodiscard]] inline bool is_seam(const Topology& mesh, const PointAttributes& attributes, HalfEdgeId h) {
  const Buffer<uint32_t>& point = attributes.point;
  const HalfEdgeId t = mesh.twin[h];
  return !attributes.empty() && (point[h] != point[t.next()] || point[h.next()] != point[t]);
}

/// Makes the points on the split edges, each the mean of the points at its ends: one for both faces, or one for each
/// face at a seam. Known displacements and given values in `displaced` replace the means. Returns [H] the new point on
/// each half-edge of a split edge; `none` elsewhere, and on faces that are not in `faces`.
[[nodiscard]] Buffer<uint32_t> split_points(const Topology& mesh, const Marks& split, const IndexRange& faces,
                                            PointAttributes& attributes, const Displacements& displaced = {});

}  // namespace papilio
