#pragma once

#include <cstdint>

#include "mesh/region.h"

namespace papilio {

/// Compact indices of marked elements, in their order.
class Ranks {
 public:
  /// Index of unmarked elements: `none`, or one shared index behind the last.
  enum class Others { without, alike };

  explicit Ranks(const Buffer<uint8_t>& marks, Others others = Others::without)
      : numbers_(marked(marks)), rank_(marks.size(), others == Others::alike ? count() : none) {
    for (uint32_t i = 0; i < numbers_.size(); ++i) rank_[numbers_[i]] = i;
  }
  [[nodiscard]] uint32_t operator[](uint32_t i) const { return rank_[i]; }
  [[nodiscard]] bool has(uint32_t i) const { return rank_[i] < count(); }
  [[nodiscard]] uint32_t count() const { return static_cast<uint32_t>(numbers_.size()); }
  /// Returns the marked elements.
  [[nodiscard]] const Buffer<uint32_t>& numbers() const { return numbers_; }

 private:
  Buffer<uint32_t> numbers_;
  Buffer<uint32_t> rank_;
};

}  // namespace papilio
