#pragma once

#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// Mesh under construction, without attributes yet.
struct Draft {
  Topology topology;
  Buffer<Vec3f> positions;             ///< [V]
  std::vector<uint32_t> corner_point;  ///< [H] the input's point at each half-edge's origin; empty without attributes
  BuildReport report;
  std::vector<uint32_t> tracked;  ///< vertices whose numbers are kept up to date
};

/// Connects the faces of a draft, given `Topology::origin` and `positions`, and counts defects. Renumbers vertices in
/// the order in which the faces first use them, and drops unused ones.
void settle(Draft& draft);

/// Connects a draft whose vertices are already numbered in the order in which the faces first use them.
void connect(Draft& draft);

/// Returns whether a mesh has more defects of connectivity than another: non-manifold or misoriented edges, pinched
/// vertices, degenerate or repeated faces.
[[nodiscard]] bool is_worse(const BuildReport& report, const BuildReport& than);

}  // namespace papilio
