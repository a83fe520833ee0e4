#pragma once

#include <vector>

#include "papilio/mesh.h"

// Parts of packed models and plain files: the faces of one material, a primitive each with a Draco stream of its own.
// In one mesh an attribute of one component has their numbers (DetailBase::triangles).

namespace papilio::proto::detail {

/// Some faces of a mesh, with their points.
struct MeshPart {
  double number = 0;  ///< 1 and that of the material among those of all parts; 0 for none
  TriangleMesh triangles{};
};

/// Whether one of the attributes has the numbers of parts.
[[nodiscard]] bool has_parts(const std::vector<Attribute>& attributes);
/// Returns the parts of a mesh by their numbers, without that attribute; one where it has none.
[[nodiscard]] std::vector<MeshPart> split_parts(const TriangleMesh& mesh);
/// Joins parts of the same attributes, one behind the other; if there are several, with their numbers as the last
/// attribute.
[[nodiscard]] TriangleMesh join_parts(std::vector<MeshPart> parts);

}  // namespace papilio::proto::detail
