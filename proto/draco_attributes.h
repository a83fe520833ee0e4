#pragma once

#include <draco/mesh/mesh.h>

#include <vector>

#include "core/mesh.h"
#include "proto/mesh_format.h"

// Attributes between Draco's meshes and the core. For the reader and the writer only.

namespace papilio::proto {

/// Throws `Problem` mesh_too_large for more than 16 attributes or 32 components besides a position. Needs no values.
void require_attributes_within_limits(const draco::PointCloud& mesh);

/// Reads everything but POSITION into `out`, whose positions are there already. Throws `Problem` mesh_unusable (a point
/// without a value).
void read_attributes(const draco::Mesh& mesh, FormattedMesh& out);

/// Which points of a mesh lie at which vertex.
class VertexPoints {
 public:
  explicit VertexPoints(const Mesh& mesh);

  [[nodiscard]] const std::vector<uint32_t>& vertex() const { return vertex_; }
  /// Points of vertices that have several of them.
  [[nodiscard]] const std::vector<uint32_t>& on_seams() const { return on_seams_; }

 private:
  std::vector<uint32_t> vertex_;  ///< [P]
  std::vector<uint32_t> on_seams_;
};

/// Adds an attribute with one value a vertex, which all its points share. Returns its number.
int add_vertex_attribute(draco::Mesh& out, draco::GeometryAttribute::Type type, const Array<Vec3f>& values,
                         const VertexPoints* points);

/// Adds an attribute of the points. Integers are rounded and held to their range. Points of one vertex share a value
/// where theirs are the same, so that it has only its own seams. Returns its number.
int add_point_attribute(draco::Mesh& out, const Attribute& attribute, const AttributeFormat& format,
                        const VertexPoints& points);

}  // namespace papilio::proto
