#pragma once

#include <cstdint>
#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// Connects the faces of `mesh`, of which only the corners and the number of vertices are known, and counts what it
/// finds at their edges. Drops faces that have the vertices and orientation of an earlier one, also from `corner_point`
/// [H], which may be empty.
void connect(Topology& mesh, std::vector<uint32_t>& corner_point, BuildReport& report);

/// Connects faces [3F corners] that already are as `build_mesh` leaves them: no repeats, no equal corners, every vertex
/// used. Makes no creases and no darts. O(n log n) at worst.
[[nodiscard]] Topology connect_faces(Buffer<uint32_t> origin, uint32_t vertex_count);

/// Numbers the edges where they were left out. Makes no creases and no darts. O(n log n) at worst.
void number_edges(Topology& mesh);
/// Leaves them out.
void forget_edges(Topology& mesh);

/// Vertices with more than one fan of faces, in ascending order. Fans end where there is no twin: no edge may be a
/// crease.
[[nodiscard]] std::vector<uint32_t> find_pinched(const Topology& mesh);

}  // namespace papilio
