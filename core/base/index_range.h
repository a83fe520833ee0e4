#pragma once

#include <cstdint>

#include "papilio/buffer.h"

namespace papilio {

/// Indices of the elements that a loop visits: all of them, or those of a list, which is in ascending order and must
/// outlive this.
class IndexRange {
 public:
  /// The numbers 0 to count - 1.
  explicit IndexRange(uint32_t count) : size_(count) {}
  explicit IndexRange(const Buffer<uint32_t>& some) : some_(some.data()), size_(static_cast<uint32_t>(some.size())) {}
  /// Those in the list, or all where there is none.
  IndexRange(uint32_t count, const Buffer<uint32_t>* some)
      : IndexRange(some == nullptr ? IndexRange(count) : IndexRange(*some)) {}

  [[nodiscard]] uint32_t size() const { return size_; }
  [[nodiscard]] uint32_t operator[](uint32_t i) const { return some_ == nullptr ? i : some_[i]; }

 private:
  const uint32_t* some_ = nullptr;
  uint32_t size_;
};

}  // namespace papilio
