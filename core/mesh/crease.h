#pragma once

#include "papilio/mesh.h"

namespace papilio {

/// Makes creases of the smooth edges at which the faces' normals differ by more than `degrees` (0..180; at 180 none),
/// and finds the darts, where a crease ends inside the surface. Edges at faces without area stay as they are. Creases
/// are curves to the rules: kept sharp, split by the rule along the curve. Where three or more curves meet, each ends.
void mark_creases(Mesh& mesh, double degrees);

/// The vertices inside the surface at which a single crease ends, in ascending order.
[[nodiscard]] std::vector<uint32_t> find_darts(const Topology& mesh);

}  // namespace papilio
