#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "papilio/vec3.h"

namespace papilio {

/// k-d tree of points (Bentley 1975), for queries near a segment. Depends on the points and their order alone.
class PointTree {
 public:
  /// Builds the tree. O(n log n).
  explicit PointTree(std::vector<Vec3d> points);

  /// Calls `visit` with the number of each point within `distance` of the segment from a to b, in the tree's order,
  /// until it returns false. Stops also once all calls together have taken `most_steps`.
  void for_each_near(Vec3d a, Vec3d b, double distance, const std::function<bool(uint32_t)>& visit);

  [[nodiscard]] bool is_exhausted() const { return steps_ > most_steps_; }

 private:
  struct Node {
    Vec3d min, max;
    uint32_t begin = 0, end = 0;  ///< range in `order_`
    uint32_t right = 0;           ///< right child, or 0 in a leaf; the left child follows its parent
  };
  uint32_t build(uint32_t begin, uint32_t end);
  /// Returns the axis of the longest side of the box of a range, which it stores in the node.
  int bound(Node& node) const;

  std::vector<Vec3d> points_;
  std::vector<uint32_t> order_;
  std::vector<Node> nodes_;
  uint64_t steps_ = 0, most_steps_;
};

}  // namespace papilio
