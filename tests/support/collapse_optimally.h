#pragma once

#include <array>
#include <stdexcept>
#include <utility>

#include "core/detail/optimal_collapse.h"

namespace papilio::test {

/// Simplifies a mesh to one size by collapse_to_sizes(). Throws `std::runtime_error` if it cannot be reached.
inline TriangleMesh collapse_optimally(const TriangleMesh& mesh, size_t faces,
                                       Quadrics quadrics = Quadrics::accumulated) {
  std::vector<TriangleMesh> made = collapse_to_sizes(mesh, std::array{faces}, quadrics);
  if (made.empty()) throw std::runtime_error("no further edge can be collapsed");
  return std::move(made[0]);
}

}  // namespace papilio::test
