#pragma once

#include "core/rules/butterfly.h"
#include "core/rules/features.h"
#include "papilio/mesh.h"

// Helpers for tests of the butterfly's rules on a whole mesh.

namespace papilio::test {

[[nodiscard]] inline Buffer<Vec3d> in_double(const Mesh& mesh) {
  Buffer<Vec3d> positions;
  positions.reserve(mesh.positions.size());
  for (Vec3f p : mesh.positions) positions.push_back(to_double(p));
  return positions;
}

/// Returns the new vertices of all edges. [E]
template <class Real>
[[nodiscard]] Buffer<Vec3T<Real>> new_vertices(const Topology& topology, const Buffer<Vec3T<Real>>& positions,
                                               const ButterflyOptions<Real>& options = {}) {
  Buffer<Vec3T<Real>> made(topology.edge_count());
  butterfly(topology, find_features(topology), positions.data(), made.data(), options);
  return made;
}

}  // namespace papilio::test
