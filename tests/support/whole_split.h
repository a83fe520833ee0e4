#pragma once

#include <vector>

#include "core/mesh/split_plan.h"
#include "papilio/mesh.h"

// What tests of the butterfly's rules ask of a whole mesh.

namespace papilio::test {

[[nodiscard]] inline Buffer<Vec3d> in_double(const Mesh& mesh) {
  Buffer<Vec3d> positions;
  positions.reserve(mesh.positions.size());
  for (Vec3f p : mesh.positions) positions.push_back(to_double(p));
  return positions;
}

/// The plan that splits every edge.
[[nodiscard]] inline SplitPlan everything(const Mesh& mesh) {
  return SplitPlan(EdgeMarks(mesh.topology.edge_count(), 1));
}

}  // namespace papilio::test
