#pragma once

#include <cstdint>
#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// Connects the faces of `mesh`, given their corners and the number of vertices, and counts edges by kind in the
/// report. Drops faces that have the vertices and orientation of an earlier one, also from `corner_point` [H], which
/// may be empty.
void connect(Topology& mesh, std::vector<uint32_t>& corner_point, BuildReport& report);

/// Connects faces [3F corners] that are valid results of build_mesh(): no repeated faces, no equal corners, no unused
/// vertices. Makes no creases and no darts. O(n log n) at worst.
[[nodiscard]] Topology connect_faces(Buffer<uint32_t> origin, uint32_t vertex_count);

/// Numbers the edges of a mesh without edges. Makes no creases and no darts. O(n log n) at worst.
void number_edges(Topology& mesh);
/// Removes the edges.
void forget_edges(Topology& mesh);

/// Returns the vertices with several fans of faces, in ascending order. Fans end where there is no twin, and no edge
/// may be a crease.
[[nodiscard]] std::vector<uint32_t> find_pinched(const Topology& mesh);

}  // namespace papilio
