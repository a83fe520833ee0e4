#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "papilio/buffer.h"

namespace papilio {

/// Disjoint sets of the numbers below a count (union-find with path halving).
class DisjointSets {
 public:
  explicit DisjointSets(uint32_t count) : above_(count) { std::iota(above_.begin(), above_.end(), 0U); }

  /// Returns the lowest number of the set that i is in.
  uint32_t find(uint32_t i) {
    while (above_[i] != i) i = above_[i] = above_[above_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) {
    a = find(a);
    b = find(b);
    above_[std::max(a, b)] = std::min(a, b);
  }

 private:
  Buffer<uint32_t> above_;
};

}  // namespace papilio
