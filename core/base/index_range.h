#pragma once

#include <cstdint>

#include "papilio/buffer.h"

namespace papilio {

/// Indices of the elements that a loop visits: all of them, or a list in ascending order, which must outlive this.
class IndexRange {
 public:
  /// Visits 0 to count - 1.
  explicit IndexRange(uint32_t count) : size_(count) {}
  explicit IndexRange(const Buffer<uint32_t>& some) : some_(some.data()), size_(static_cast<uint32_t>(some.size())) {}

  [[nodiscard]] uint32_t size() const { return size_; }
  [[nodiscard]] uint32_t operator[](uint32_t i) const { return some_ == nullptr ? i : some_[i]; }

 private:
  const uint32_t* some_ = nullptr;
  uint32_t size_;
};

}  // namespace papilio
