#pragma once

#include <vector>

#include "papilio/mesh.h"

// Parts of packed models and plain files: the faces of one material, as a primitive with its own Draco stream. In a
// mesh of several parts, an attribute of one component holds their numbers (DetailBase::triangles).

namespace papilio::proto::detail {

/// Faces of one part of a mesh, with their points.
struct MeshPart {
  double number = 0;  ///< 1 + index of the material among the parts' materials; 0 without a material
  TriangleMesh triangles{};
};

/// Returns whether one of the attributes holds part numbers.
[[nodiscard]] bool has_parts(const std::vector<Attribute>& attributes);
/// Returns the parts of a mesh by their numbers, without the attribute of part numbers; one part if it has none.
[[nodiscard]] std::vector<MeshPart> split_parts(const TriangleMesh& mesh);
/// Joins parts with equal attributes in their order. Several parts get their numbers as the last attribute.
[[nodiscard]] TriangleMesh join_parts(std::vector<MeshPart> parts);

}  // namespace papilio::proto::detail
