#pragma once

#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// A mesh that is being built: its attributes are not gathered yet.
struct Draft {
  Topology topology;
  Buffer<Vec3f> positions;             ///< [V]
  std::vector<uint32_t> corner_point;  ///< [H] the input's point at each half-edge's origin; empty without attributes
  BuildReport report;
  std::vector<uint32_t> tracked;  ///< vertices whose numbers are kept up to date
};

/// Connects the faces of a draft, of which only `Topology::origin` and `positions` must be right, and counts what is
/// found. Vertices are numbered in the order in which the faces name them; those that none names are dropped.
void settle(Draft& draft);

/// Connects a draft whose vertices are numbered so already.
void connect(Draft& draft);

/// Returns whether a mesh has more defects of connectivity than another: edges with three faces, edges with two faces
/// that run along them in one direction, pinched vertices, faces without area or repeated.
[[nodiscard]] bool is_worse(const BuildReport& report, const BuildReport& than);

}  // namespace papilio
