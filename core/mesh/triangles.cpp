#include <cstring>

#include "base/ids.h"
#include "papilio/mesh.h"

namespace papilio {
namespace {

Buffer<Triangle> in_threes(const Buffer<uint32_t>& corners) {
  auto triangles = Buffer<Triangle>::for_overwrite(corners.size() / 3);
  static_assert(sizeof(Triangle) == 3 * sizeof(uint32_t));
  if (!corners.empty()) std::memcpy(triangles.data(), corners.data(), corners.size() * sizeof(uint32_t));
  return triangles;
}

TriangleMesh points_and_triangles(const Mesh& mesh) {
  const PointAttributes& points = mesh.attributes;
  TriangleMesh out{Buffer<Vec3f>::for_overwrite(points.point_count), in_threes(points.point), points.attributes};
  for (HalfEdgeId h = 0; h < points.point.size(); ++h)
    out.positions[points.point[h]] = mesh.positions[mesh.topology.origin[h]];
  return out;
}

}  // namespace

TriangleMesh Mesh::triangles() const& {
  if (!attributes.empty()) return points_and_triangles(*this);
  return {positions, in_threes(topology.origin)};
}

TriangleMesh Mesh::triangles() && {
  if (!attributes.empty()) return points_and_triangles(*this);
  return {std::move(positions), in_threes(topology.origin)};
}

}  // namespace papilio
