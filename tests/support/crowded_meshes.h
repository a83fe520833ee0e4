#pragma once

#include <cstdint>
#include <string>

#include "papilio/mesh.h"

// Meshes with many faces at one vertex or edge, which expose work quadratic in the valence.

namespace papilio::test {

/// Faces that share the edge between two vertices.
[[nodiscard]] TriangleMesh faces_at_one_edge(uint32_t faces);
/// Triangles that share only one vertex.
[[nodiscard]] TriangleMesh triangles_at_one_vertex(uint32_t faces);
/// A closed cone with faces in random order. Seen from below they are back faces.
[[nodiscard]] TriangleMesh shuffled_cone(uint32_t faces);

/// A Draco stream of 4 * triangles - 3 faces: each triangle is merged at one vertex, whose corners the decoder
/// renumbers each time.
[[nodiscard]] std::string merging_stream(uint32_t triangles);

}  // namespace papilio::test
