#pragma once

#include <cstdint>
#include <functional>

namespace papilio::proto::edgebreaker {

/// Cancellation of long loops: calls a function once in many steps. The function may throw to stop the loop.
class Poller {
 public:
  /// Steps between two calls: a few milliseconds of work.
  static constexpr uint32_t steps_per_call = 1 << 16;

  /// Calls nothing if `poll` is empty.
  explicit Poller(std::function<void()> poll) : poll_(std::move(poll)) {}

  void step() {
    if (++steps_ % steps_per_call == 0) [[unlikely]]
      call();
  }
  void call() const {
    if (poll_) poll_();
  }

 private:
  std::function<void()> poll_;
  uint32_t steps_ = 0;
};

}  // namespace papilio::proto::edgebreaker
