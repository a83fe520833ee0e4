#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace papilio::server {

/// Counter of running requests that, once closed, admits no more. Thread-safe.
class Gate {
 public:
  /// Counts a running request until leave(). Returns false if the gate is closed.
  bool enter();
  void leave();
  void close();
  [[nodiscard]] bool closed() const;
  [[nodiscard]] int running() const;
  /// Waits until no request runs. Returns false after `longest`.
  bool wait_until_empty(std::chrono::seconds longest);

 private:
  mutable std::mutex mutex_;
  std::condition_variable emptied_;
  int running_ = 0;
  bool closed_ = false;
};

}  // namespace papilio::server
