#pragma once

#include "papilio/mesh.h"

namespace papilio {

/// Makes creases of the smooth edges at which the faces' normals differ by more than `degrees` (0..180; none at 180),
/// and finds the darts. Skips edges at faces without area.
void mark_creases(Mesh& mesh, double degrees);

/// Returns the interior vertices at which a single crease ends, in ascending order.
[[nodiscard]] std::vector<uint32_t> find_darts(const Topology& mesh);

}  // namespace papilio
