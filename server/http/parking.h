#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>

namespace papilio::server {

/// Sockets of silent clients: each takes a descriptor, but no thread. Thread-safe.
class Parking {
 public:
  using Clock = std::chrono::steady_clock;

  /// Provides room for `most` > 0 sockets. Throws std::system_error if the system lacks resources.
  explicit Parking(size_t most);
  ~Parking();
  Parking(const Parking&) = delete;
  Parking& operator=(const Parking&) = delete;

  /// Calls `resume` once, on the parking's thread, when the socket is ready for `events` (of poll), has failed, or the
  /// deadline has passed. `resume` owns the socket; it is destroyed without a call when the parking is closed. When the
  /// parking is full, the socket with the next deadline is dropped.
  void park(int fd, short events, Clock::time_point deadline, std::function<void()> resume);
  /// Destroys parked sockets, and those parked later.
  void close();

 private:
  struct Parked {
    int fd;
    Clock::time_point deadline;
    std::function<void()> resume;
  };

  void run();
  /// Returns the milliseconds until the next deadline, -1 without one; nothing once closed.
  [[nodiscard]] std::optional<int> milliseconds_to_wait();
  /// Takes out a socket whose deadline has passed; empty if there is none, or if the parking is closed.
  [[nodiscard]] std::function<void()> take_overdue();
  [[nodiscard]] std::function<void()> take(uint64_t id);
  /// Takes out a socket, with the mutex held; empty if there is none.
  [[nodiscard]] std::function<void()> take_locked(uint64_t id);
  void wake() const;

  const size_t most_;
  const int epoll_;
  const int wake_;    ///< eventfd that wakes the thread
  std::mutex mutex_;  ///< guards the fields that follow
  std::map<uint64_t, Parked> parked_;
  std::set<std::pair<Clock::time_point, uint64_t>> deadlines_;
  uint64_t next_id_ = 1;
  bool closed_ = false;
  std::thread thread_;
};

}  // namespace papilio::server
