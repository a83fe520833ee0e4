#pragma once

#include <atomic>
#include <cstddef>

#include "papilio/buffer.h"

namespace papilio {

/// Lazily computed per-element values. Any number of threads may read and write at once; at worst, several compute one
/// value.
template <class Number>
class LazyValues {
 public:
  LazyValues() = default;
  /// Fills with `unknown`, the sentinel of values that are not computed yet.
  LazyValues(size_t count, Number unknown) : numbers_(count, unknown) {}

  [[nodiscard]] Number get(size_t i) const {
    return std::atomic_ref<Number>(numbers_[i]).load(std::memory_order_relaxed);
  }
  void put(size_t i, Number number) const {
    std::atomic_ref<Number>(numbers_[i]).store(number, std::memory_order_relaxed);
  }
  [[nodiscard]] bool empty() const { return numbers_.empty(); }
  [[nodiscard]] size_t bytes() const { return numbers_.capacity() * sizeof(Number); }

 private:
  mutable Buffer<Number> numbers_;
};

}  // namespace papilio
