#pragma once

#include <atomic>
#include <cstddef>

#include "papilio/buffer.h"

namespace papilio {

/// Numbers that follow from what they belong to, each computed when somebody asks for it first. Any number of threads
/// may ask at once: at worst several compute the same.
template <class Number>
class Memo {
 public:
  Memo() = default;
  /// `unknown` stands for what was not computed yet.
  Memo(size_t count, Number unknown) : numbers_(count, unknown) {}

  [[nodiscard]] Number get(size_t i) const {
    return std::atomic_ref<Number>(numbers_[i]).load(std::memory_order_relaxed);
  }
  void put(size_t i, Number number) const {
    std::atomic_ref<Number>(numbers_[i]).store(number, std::memory_order_relaxed);
  }
  [[nodiscard]] bool empty() const { return numbers_.empty(); }
  [[nodiscard]] size_t bytes() const { return numbers_.capacity() * sizeof(Number); }

 private:
  mutable List<Number> numbers_;
};

}  // namespace papilio
