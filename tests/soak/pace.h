#pragma once

#include <condition_variable>
#include <mutex>

namespace papilio::soak {

/// Gate at which all clients can be paused.
class Pace {
 public:
  /// Blocks while clients are paused. Returns false once the run is over.
  bool begin_turn() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !still_ || over_; });
    if (!over_) ++running_;
    return !over_;
  }
  void end_turn() {
    const std::lock_guard lock(mutex_);
    --running_;
    changed_.notify_all();
  }
  /// Pauses all clients: returns when no turn is in progress. No turn begins until go_on().
  void keep_still() {
    std::unique_lock lock(mutex_);
    still_ = true;
    changed_.wait(lock, [this] { return running_ == 0; });
  }
  void go_on() {
    const std::lock_guard lock(mutex_);
    still_ = false;
    changed_.notify_all();
  }
  void end() {
    const std::lock_guard lock(mutex_);
    over_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int running_ = 0;
  bool still_ = false;
  bool over_ = false;
};

}  // namespace papilio::soak
