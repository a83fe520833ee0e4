#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>

#include "proto/problem.h"

namespace papilio::server {

/// Lets a fixed number of requests compute at once and a few more wait their turn, first come first served.
/// Threads may share it.
class Admission {
 public:
  /// `slots` > 0 requests compute at once; up to `queue` wait.
  Admission(int slots, int queue);

  /// Gives the slot back when it is destroyed.
  class Slot {
   public:
    /// With the mutex held. What makes it counts it, so that none is counted that could not be made.
    explicit Slot(Admission& admission) : admission_(&admission) { ++admission_->computing_; }
    ~Slot() { admission_->leave(); }
    Slot(const Slot&) = delete;
    Slot& operator=(const Slot&) = delete;

   private:
    Admission* admission_;
  };

  /// Waits for a slot. Throws `Problem`: busy when the queue is full, cancelled when `client_gone` says so
  /// while waiting (asked ten times a second, and once more before the slot is given).
  [[nodiscard]] std::shared_ptr<Slot> enter(const std::function<bool()>& client_gone);

  [[nodiscard]] int computing() const;
  [[nodiscard]] int waiting() const;
  /// No request that came now would be let in.
  [[nodiscard]] bool full() const;
  /// Throws `Problem` busy then: to be asked before a body is read that would only be held for nothing.
  void refuse_when_full() const;

 private:
  void leave();
  [[nodiscard]] bool is_full() const { return computing_ + static_cast<int>(waiting_.size()) >= slots_ + queue_; }
  [[nodiscard]] proto::Problem busy() const;

  const int slots_;
  const int queue_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  int computing_ = 0;
  std::list<uint64_t> waiting_;  ///< tickets in the order in which they came
  uint64_t next_ticket_ = 0;
};

}  // namespace papilio::server
