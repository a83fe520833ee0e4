#pragma once

#include <cstdint>
#include <string>

#include "papilio/mesh.h"

// Meshes whose faces crowd at one vertex or edge: where work that is quadratic in the valence shows.

namespace papilio::test {

/// Faces that all have the edge between two vertices.
[[nodiscard]] TriangleMesh faces_at_one_edge(uint32_t faces);
/// Triangles with one vertex in common, and nothing else.
[[nodiscard]] TriangleMesh triangles_at_one_vertex(uint32_t faces);
/// A closed cone, its faces in random order. From below it faces away.
[[nodiscard]] TriangleMesh shuffled_cone(uint32_t faces);

/// A Draco stream of 4 * triangles - 3 faces: triangles that are merged one by one at a vertex, all of whose corners
/// the decoder renumbers each time.
[[nodiscard]] std::string merging_stream(uint32_t triangles);

}  // namespace papilio::test
