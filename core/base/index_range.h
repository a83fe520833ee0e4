#pragma once

#include <cstdint>

#include "papilio/buffer.h"

namespace papilio {

/// Which of a mesh's faces, say, something is done with: all, or those in a list, which is in ascending order and must
/// outlive this.
class Subset {
 public:
  /// The numbers 0 to count - 1.
  explicit Subset(uint32_t count) : size_(count) {}
  explicit Subset(const List<uint32_t>& some) : some_(some.data()), size_(static_cast<uint32_t>(some.size())) {}
  /// Those in the list, or all where there is none.
  Subset(uint32_t count, const List<uint32_t>* some) : Subset(some == nullptr ? Subset(count) : Subset(*some)) {}

  [[nodiscard]] uint32_t size() const { return size_; }
  [[nodiscard]] uint32_t operator[](uint32_t i) const { return some_ == nullptr ? i : some_[i]; }

 private:
  const uint32_t* some_ = nullptr;
  uint32_t size_;
};

}  // namespace papilio
