#pragma once

#include <cstdint>
#include <vector>

#include "papilio/mesh.h"

namespace papilio {

/// One mark an edge: not 0 where the edge is a target, to be split. Shape [E].
using EdgeMarks = Buffer<uint8_t>;

/// The target edges, numbered: edge e is split when before[e + 1] != before[e], and its new vertex is
/// vertex_count + before[e] of the next level.
struct SplitPlan {
  Buffer<uint32_t> before;  ///< [E + 1] how many target edges come before each edge

  SplitPlan() = default;  ///< of no edges
  explicit SplitPlan(const EdgeMarks& marks) : before(marks.size() + 1) {
    uint32_t count = 0;
    for (size_t e = 0; e < marks.size(); ++e) {
      before[e] = count;
      count += marks[e] != 0 ? 1 : 0;
    }
    before.back() = count;
  }

  [[nodiscard]] uint32_t count() const { return before.empty() ? 0 : before.back(); }
  [[nodiscard]] bool is_split(uint32_t e) const { return before[e + 1] != before[e]; }
};

/// Bit i is set where edge i of the face is split.
[[nodiscard]] inline unsigned split_mask(const Topology& mesh, const SplitPlan& plan, uint32_t face) {
  unsigned mask = 0;
  for (uint32_t i = 0; i < 3; ++i) mask |= plan.is_split(mesh.edge[3 * face + i]) ? 1U << i : 0U;
  return mask;
}

}  // namespace papilio
