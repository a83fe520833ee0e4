#pragma once

#include <cstdint>
#include <functional>

namespace papilio::proto::edgebreaker {

/// Lets long loops be stopped: calls a function once in many steps, which may throw.
class Pace {
 public:
  /// Steps from one call to the next: some milliseconds of work.
  static constexpr uint32_t steps_a_call = 1 << 16;

  /// `poll` may be empty.
  explicit Pace(std::function<void()> poll) : poll_(std::move(poll)) {}

  void step() {
    if (++steps_ % steps_a_call == 0) [[unlikely]]
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
