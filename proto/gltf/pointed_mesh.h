#pragma once

#include <vector>

#include "papilio/mesh.h"
#include "proto/gltf/geometry.h"

namespace papilio::proto::gltf {

/// Mesh of a primitive whose points refer to vertices of its set. Attributes are not copied, as the core would store
/// them as doubles.
struct PointedMesh {
  Mesh mesh;                     ///< mesh; its attributes have only `point` and `point_count`
  std::vector<uint32_t> vertex;  ///< [points] vertex of the set; empty if the set has only positions

  /// Returns the numbers of each point.
  [[nodiscard]] std::vector<double> values_of(const Elements& elements) const;
};

/// Builds the mesh of a set's vertices and triangles, as build_mesh() would from all attributes: vertices with equal
/// positions and attributes are one point. Consumes the bytes of POSITION. Throws `Error` as build_mesh().
[[nodiscard]] PointedMesh build_pointed_mesh(VertexSet& set, Buffer<Triangle> triangles);

}  // namespace papilio::proto::gltf
