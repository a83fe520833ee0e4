#pragma once

#include <cstdint>
#include <functional>
#include <utility>

namespace papilio {

/// Calls a function now and then during long work; the function may throw to stop it. Not for threads to share.
class Poller {
 public:
  Poller() = default;  ///< calls nothing
  explicit Poller(std::function<void()> poll) : poll_(std::move(poll)) {}

  /// Calls the function.
  void now() const {
    if (poll_) poll_();
  }
  /// Counts a step, of some microseconds at most, and calls the function once in a few thousand.
  void step() const {
    if (++steps_ % steps_between_polls == 0) now();
  }

 private:
  static constexpr uint32_t steps_between_polls = 4096;

  std::function<void()> poll_;
  mutable uint32_t steps_ = 0;
};

}  // namespace papilio
