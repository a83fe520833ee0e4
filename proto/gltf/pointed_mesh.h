#pragma once

#include <vector>

#include "papilio/mesh.h"
#include "proto/gltf/geometry.h"

namespace papilio::proto::gltf {

/// The mesh of a primitive, whose points are vertices of its set: their attributes stay where they are, as the core has
/// them as doubles.
struct PointedMesh {
  Mesh mesh;                     ///< of its attributes only `point` and `point_count` are set
  std::vector<uint32_t> vertex;  ///< [points] vertex of the set; empty where the set has positions alone

  /// Returns the numbers of each point.
  [[nodiscard]] std::vector<double> values_of(const Elements& elements) const;
};

/// Builds the mesh of a set's vertices and triangles, as build_mesh() does from all attributes: vertices of equal
/// position and equal attributes are one point. Takes the bytes of POSITION. Throws `Error` like build_mesh().
[[nodiscard]] PointedMesh build_pointed_mesh(VertexSet& set, Buffer<Triangle> triangles);

}  // namespace papilio::proto::gltf
