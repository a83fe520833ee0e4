#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace papilio::server {

/// Counts the requests being answered and, once closed, lets no further one in. Any thread may use it.
class Gate {
 public:
  /// False once closed; else the request counts as running until `leave`.
  bool enter();
  void leave();
  void close();
  [[nodiscard]] bool closed() const;
  [[nodiscard]] int running() const;
  /// True when nothing runs, false when the time was over first.
  bool wait_until_empty(std::chrono::seconds longest);

 private:
  mutable std::mutex mutex_;
  std::condition_variable emptied_;
  int running_ = 0;
  bool closed_ = false;
};

}  // namespace papilio::server
